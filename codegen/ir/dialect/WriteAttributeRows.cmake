# Writes what C++ reads of RtslDiscardableAttributes.td, a row for each record:
#
#   RTSL_ATTRIBUTE(frameSize, "frame_size", IntegerAttr, "must be an integer", "func.func")
#
# cmake -DTABLEGEN=llvm-tblgen -DRECORDS=FILE.td -DROWS=FILE.inc -P WriteAttributeRows.cmake
execute_process(COMMAND "${TABLEGEN}" --dump-json "${RECORDS}"
  OUTPUT_VARIABLE records COMMAND_ERROR_IS_FATAL ANY)
set(rows "// Written from RtslDiscardableAttributes.td.\n")
string(JSON count LENGTH "${records}" !instanceof DiscardableAttribute)
math(EXPR last "${count} - 1")
foreach(i RANGE ${last})
  string(JSON name GET "${records}" !instanceof DiscardableAttribute ${i})
  string(JSON word GET "${records}" ${name} word)
  string(JSON kind GET "${records}" ${name} kind def)
  string(JSON class GET "${records}" ${kind} cppClass)
  string(JSON rule GET "${records}" ${kind} rule)
  string(JSON operations GET "${records}" ${name} operations)
  string(REGEX REPLACE "[][\" \n]" "" operations "${operations}")
  string(REPLACE "," ", " operations "${operations}")
  string(APPEND rows
    "RTSL_ATTRIBUTE(${name}, \"${word}\", ${class}, \"${rule}\", \"${operations}\")\n")
endforeach()
string(APPEND rows "#undef RTSL_ATTRIBUTE\n")
file(CONFIGURE OUTPUT "${ROWS}" CONTENT "${rows}" @ONLY)
