# Tests of gonio::light.
gonio_test(ies_test LIBS gonio::light)
gonio_test(eulumdat_test LIBS gonio::light)
gonio_test(sphere_test LIBS gonio::light gonio::proof)
gonio_test(photometry_test LIBS gonio::light)
gonio_test(ldt_test LIBS gonio::light)
gonio_test(light_export_test LIBS gonio::light_exr OpenEXR::OpenEXR)

# The GLSL include: compiled by glslang, run by Mesa's software OpenGL.
find_package(OpenGL REQUIRED COMPONENTS OpenGL EGL)
find_program(GLSLANG glslangValidator REQUIRED)
set(glsl_folder ${PROJECT_SOURCE_DIR}/mapping/light/glsl)
set(ldt_spirv ${CMAKE_CURRENT_BINARY_DIR}/ldt.spv)
add_custom_command(OUTPUT ${ldt_spirv}
  COMMAND ${GLSLANG} --quiet -G100 -I${glsl_folder} -o ${ldt_spirv} ${PROJECT_SOURCE_DIR}/tests/glsl/ldt.comp
  DEPENDS ${PROJECT_SOURCE_DIR}/tests/glsl/ldt.comp ${glsl_folder}/ldt.glsl VERBATIM)
add_custom_target(ldt_spirv DEPENDS ${ldt_spirv})
gonio_test(glsl_test LIBS gonio::light OpenGL::OpenGL OpenGL::EGL)
target_compile_definitions(glsl_test PRIVATE GONIO_LDT_SPIRV="${ldt_spirv}")
add_dependencies(glsl_test ldt_spirv)
# As a program pastes it into its own shader, without the include extension.
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS
  ${glsl_folder}/ldt.glsl ${PROJECT_SOURCE_DIR}/tests/glsl/point_light.frag)
file(READ ${glsl_folder}/ldt.glsl ldt_include)
file(READ ${PROJECT_SOURCE_DIR}/tests/glsl/point_light.frag point_light)
string(REPLACE "#include \"ldt.glsl\"" "${ldt_include}" point_light "${point_light}")
file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/point_light.frag "${point_light}")
add_test(NAME glsl_330 COMMAND ${GLSLANG} ${CMAKE_CURRENT_BINARY_DIR}/point_light.frag)
add_test(NAME glsl_vulkan
  COMMAND ${GLSLANG} -V -I${glsl_folder} -o ${CMAKE_CURRENT_BINARY_DIR}/ldt_vulkan.spv
    ${PROJECT_SOURCE_DIR}/tests/glsl/ldt.comp)

gonio_test(light_tool_test LIBS gonio::light_exr)
target_compile_definitions(light_tool_test PRIVATE GONIO_TOOL="$<TARGET_FILE:gonio_tool>")
add_dependencies(light_tool_test gonio_tool)
