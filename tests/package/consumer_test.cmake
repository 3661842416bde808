# Installs the build into an empty prefix, compares what arrived with install_manifest.txt, then
# configures, builds and runs consumer/ against it: as a renderer, for which OpenEXR, Ceres and Boost do not exist, with
# each component, and by pkg-config.
# cmake -DBUILD_DIR= -DCONFIG= -DGONIO= -DLIBDIR= -DCXX= -DCXX_FLAGS= -P consumer_test.cmake
cmake_minimum_required(VERSION 3.25)
find_program(NINJA ninja REQUIRED)
set(work ${BUILD_DIR}/package_test)
set(prefix ${work}/prefix)
file(REMOVE_RECURSE ${work})

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    list(JOIN ARGN " " command)
    message(NOTICE "${output}")
    message(FATAL_ERROR "failed (${status}): ${command}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

# The install
run(${CMAKE_COMMAND} --install ${BUILD_DIR} --config ${CONFIG} --prefix ${prefix})
file(GLOB_RECURSE installed RELATIVE ${prefix} ${prefix}/*)
list(SORT installed)
list(JOIN installed "\n" installed)
string(TOLOWER "-${CONFIG}.cmake" config_suffix)
string(REPLACE "${config_suffix}" "-release.cmake" installed "${installed}\n")
string(REPLACE "${LIBDIR}/" "lib/" installed "${installed}")
file(WRITE ${work}/install_manifest.txt "${installed}")
file(READ ${CMAKE_CURRENT_LIST_DIR}/install_manifest.txt expected)
if(NOT installed STREQUAL expected)
  execute_process(COMMAND diff -u ${CMAKE_CURRENT_LIST_DIR}/install_manifest.txt ${work}/install_manifest.txt
    OUTPUT_VARIABLE difference)
  message(NOTICE "${difference}If that is meant:\n"
    "cp ${work}/install_manifest.txt ${CMAKE_CURRENT_LIST_DIR}/install_manifest.txt")
  message(FATAL_ERROR "The installed files are not those of tests/package/install_manifest.txt")
endif()

# What comes with the program is found there.
run(${prefix}/bin/gonio render --size 16x16 --samples 1 -o ${work}/iris.png)

# consume(NAME option...): builds and runs a consumer. `libraries` becomes what its link command names,
# without gonio's own, and `headers` all files that it was compiled from.
function(consume name)
  set(build ${work}/${name})
  run(${CMAKE_COMMAND} -G Ninja -S ${CMAKE_CURRENT_LIST_DIR}/consumer -B ${build}
    -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_BUILD_TYPE=${CONFIG} -DCMAKE_CXX_COMPILER=${CXX}
    -DCMAKE_CXX_FLAGS=${CXX_FLAGS} ${ARGN})
  run(${NINJA} -C ${build})
  run(${build}/consumer ${work}/table.binary)

  run(${NINJA} -C ${build} -t commands)
  string(REGEX MATCHALL "/lib[^ /]+\\.(a|so)[.0-9]*| -l[^ ]+" libraries "${output}")
  list(FILTER libraries EXCLUDE REGEX "^/libgonio_")
  run(${NINJA} -C ${build} -t deps)
  string(REPLACE "${BUILD_DIR}" "" headers "${output}")  # our own folder may be called anything
  set(libraries "${libraries}" PARENT_SCOPE)
  set(headers "${headers}" PARENT_SCOPE)
endfunction()

run(${GONIO} synth default -o ${work}/table.binary)

consume(renderer -DCMAKE_DISABLE_FIND_PACKAGE_OpenEXR=ON -DCMAKE_DISABLE_FIND_PACKAGE_Ceres=ON -DCMAKE_DISABLE_FIND_PACKAGE_Boost=ON)
list(FILTER libraries EXCLUDE REGEX "^/libhwy")
if(libraries)
  message(FATAL_ERROR "A consumer of gonio::brdf alone is linked with${libraries}, expected Highway alone")
endif()
if(headers MATCHES "/(OpenEXR|Imath|ceres|eigen3|Eigen|nlohmann|boost|hwy)/")
  message(NOTICE "${headers}")
  message(FATAL_ERROR "A consumer of gonio::brdf alone is compiled from headers of ${CMAKE_MATCH_1}")
endif()

# The same searches find what is there: they are able to fail.
if(NOT headers MATCHES "/(glm)/")
  message(FATAL_ERROR "No header of GLM found in:\n${headers}")
endif()
consume(exr -DCOMPONENT=exr)
if(NOT libraries MATCHES "/libOpenEXR")
  message(FATAL_ERROR "A consumer of gonio::exr is linked with these alone: ${libraries}")
endif()
consume(fitting -DCOMPONENT=fitting)
if(NOT libraries MATCHES "/libceres")
  message(FATAL_ERROR "A consumer of gonio::fitting is linked with these alone: ${libraries}")
endif()
foreach(component light light_exr ndf proof)
  consume(${component} -DCOMPONENT=${component})
endforeach()

find_program(PKG_CONFIG_EXECUTABLE pkg-config)
if(PKG_CONFIG_EXECUTABLE)
  set(ENV{PKG_CONFIG_PATH} ${prefix}/${LIBDIR}/pkgconfig)
  consume(pkg_config -DPKG_CONFIG=ON)
endif()
