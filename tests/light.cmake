# Tests of gonio::light.
gonio_test(ies_test LIBS gonio::light)
gonio_test(eulumdat_test LIBS gonio::light)
gonio_test(sphere_test LIBS gonio::light Boost::headers)
gonio_test(photometry_test LIBS gonio::light)
gonio_test(ldt_test LIBS gonio::light)
find_package(OpenEXR REQUIRED)
gonio_test(light_export_test LIBS gonio::light_exr OpenEXR::OpenEXR)
