// A table of a BRDF is no luminaire.
#include <gonio/mapping/light/exr/light_exr.h>

int main(int argc, char** argv) { return argc == 2 && !gonio::is_light_file(argv[1]) ? 0 : 1; }
