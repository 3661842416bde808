// The image of the normals of a table.
#include <gonio/brdf/ndf/image/disk_image.h>
#include <gonio/brdf/ndf/image/disk_image_file.h>
#include <gonio/brdf/ndf/image/solid_angle.h>

int main() { return gonio::orthographic_solid_angle(0.0, 0.5, 0.0, 0.5) > 0.25 ? 0 : 1; }
