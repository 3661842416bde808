# Installs the build into an empty prefix, compares what arrived with install_manifest.txt, then
# configures, builds and runs consumer/ against it, twice: as a renderer, for which OpenEXR and Ceres
# do not exist, and with all components.
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
    message(FATAL_ERROR "${command}\nfailed (${status}):\n${output}")
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
  message(FATAL_ERROR "The installed files are not those of tests/install_manifest.txt:\n${difference}\n"
    "If that is meant: cp ${work}/install_manifest.txt ${CMAKE_CURRENT_LIST_DIR}/")
endif()

# consume(NAME option...): builds and runs a consumer; `uses` becomes its link command and all headers
# that it was compiled from.
function(consume name)
  set(build ${work}/${name})
  run(${CMAKE_COMMAND} -G Ninja -S ${CMAKE_CURRENT_LIST_DIR}/consumer -B ${build}
    -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_BUILD_TYPE=${CONFIG} -DCMAKE_CXX_COMPILER=${CXX}
    -DCMAKE_CXX_FLAGS=${CXX_FLAGS} ${ARGN})
  run(${NINJA} -C ${build})
  run(${NINJA} -C ${build} -t commands)
  set(uses "${output}")
  run(${NINJA} -C ${build} -t deps)
  # Our own folder may be called anything.
  string(REPLACE "${BUILD_DIR}" "" uses "${uses}${output}")
  run(${build}/consumer ${work}/table.binary)
  set(uses "${uses}" PARENT_SCOPE)
endfunction()

run(${GONIO} synth default -o ${work}/table.binary)
set(heavy /OpenEXR/ libOpenEXR /Imath/ libImath /ceres/ libceres /eigen3/)

consume(renderer -DCMAKE_DISABLE_FIND_PACKAGE_OpenEXR=ON -DCMAKE_DISABLE_FIND_PACKAGE_Ceres=ON)
foreach(name ${heavy})
  string(FIND "${uses}" ${name} position)
  if(NOT position EQUAL -1)
    message(FATAL_ERROR "A consumer of gonio::brdf alone is built with ${name}:\n${uses}")
  endif()
endforeach()

# The same search finds all of them where they are used: it is able to fail.
consume(all "-DGONIO_COMPONENTS=exr\;fitting")
foreach(name ${heavy})
  string(FIND "${uses}" ${name} position)
  if(position EQUAL -1)
    message(FATAL_ERROR "A consumer of all components is built without ${name}:\n${uses}")
  endif()
endforeach()
