# Writes OUTPUT, a C++ file with a page as two strings, NAME_head and NAME_tail: what goes before the report and what after.
# In: NAME, PAGE (its HTML file), SCRIPTS (its scripts, in order), PAGE_DIR (this folder), VEGA_DIR (the modules of libjs-vega), VEGA_LICENCE, LICENCE (of gonio), OUTPUT.

cmake_minimum_required(VERSION 3.25)

# In the order of their dependencies, which is for the reader: they are looked up by name.
set(modules
  vega-util vega-time vega-format vega-loader vega-dataflow vega-scale vega-canvas vega-scenegraph
  vega-expression vega-event-selector vega-selection vega-statistics vega-functions vega-runtime
  vega-parser vega-view vega-encode vega-transforms vega-view-transforms vega-label)

set(vega "const gonio_modules = {};\n")
foreach(module ${modules})
  file(READ ${VEGA_DIR}/${module}.min.js text)
  string(REGEX REPLACE "//# sourceMappingURL=[^\n]*" "" text "${text}")
  set(name ${module})
  if(name STREQUAL "vega-selection")
    set(name vega-selections)  # the file's name lacks an s
  endif()
  string(APPEND vega "gonio_modules['${name}'] = function (module, exports, require) {\n${text}\n};\n")
endforeach()
file(READ ${PAGE_DIR}/modules.js text)
string(APPEND vega "${text}")

set(script "'use strict';\n(() => {\n")
foreach(file ${SCRIPTS})
  file(READ ${file} text)
  string(APPEND script "${text}\n")
endforeach()
string(APPEND script "})();\n")

set(licences "")
foreach(part "gonio|${LICENCE}" "D3, of which Vega's modules contain parts|${PAGE_DIR}/d3_licence.txt" "Vega|${VEGA_LICENCE}")
  string(REPLACE "|" ";" part "${part}")
  list(GET part 0 title)
  list(GET part 1 path)
  file(READ ${path} text)
  string(REPLACE "&" "&amp;" text "${text}")
  string(REPLACE "<" "&lt;" text "${text}")
  string(APPEND licences "== ${title} ==\n\n${text}\n")
endforeach()

file(READ ${PAGE} page)
file(READ ${PAGE_DIR}/page.css style)
foreach(part style licences vega script)
  if(part STREQUAL "vega" OR part STREQUAL "script")
    string(FIND "${${part}}" "</script" found)
    if(NOT found EQUAL -1)
      message(FATAL_ERROR "${part}: holds </script, which would end it")
    endif()
  endif()
  string(TOUPPER ${part} mark)
  string(REPLACE "@${mark}@" "${${part}}" page "${page}")
endforeach()

string(FIND "${page}" "@REPORT@" cut)
string(SUBSTRING "${page}" 0 ${cut} head)
math(EXPR cut "${cut} + 8")
string(SUBSTRING "${page}" ${cut} -1 tail)
file(WRITE ${OUTPUT} "namespace gonio {
extern const char ${NAME}_head[], ${NAME}_tail[];
const char ${NAME}_head[] = R\"GONIO_PAGE(${head})GONIO_PAGE\";
const char ${NAME}_tail[] = R\"GONIO_PAGE(${tail})GONIO_PAGE\";
}
")
