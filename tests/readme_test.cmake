# cmake -DSOURCE_DIR=... -P readme_test.cmake: the example in the README is the file that is compiled.
file(READ ${SOURCE_DIR}/README.md readme)
file(READ ${SOURCE_DIR}/docs/examples/path_tracer.cpp example)
string(FIND "${readme}" "```cpp\n${example}```" position)
if(position EQUAL -1)
  message(FATAL_ERROR "README.md: its C++ block differs from docs/examples/path_tracer.cpp; copy that file into it")
endif()
