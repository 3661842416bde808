# cmake -DSOURCE_DIR=... -P readme_test.cmake: the examples in the documents are the files that are compiled.
function(expect_quoted document example)
  file(READ ${SOURCE_DIR}/${document} text)
  file(READ ${SOURCE_DIR}/docs/examples/${example} code)
  string(FIND "${text}" "```cpp\n${code}```" position)
  if(position EQUAL -1)
    message(FATAL_ERROR "${document}: its C++ block differs from docs/examples/${example}; copy that file into it")
  endif()
endfunction()

expect_quoted(README.md first.cpp)
expect_quoted(README.md path_tracer.cpp)
expect_quoted(docs/guide/integrate.md pbrt_bxdf.h)
expect_quoted(docs/guide/integrate.md mitsuba_bsdf.h)
