# Lets clang-tidy look at SOURCE, unless RECORD says that it found nothing in the same text: to look at all sources takes longer than
# all tests do. Writes to STAMP what RECORD is to say of it, and to STAMP.d what it read.
#
# ROOT, SOURCE (relative to it), STAMP, RECORD, CLANG_TIDY, COMMANDS_FOLDER.
cmake_minimum_required(VERSION 3.25)

# The text is that of the source and of all headers of the project that it reads, and of how clang-tidy is told to look.
set(files ${SOURCE})
set(unread ${SOURCE})
while(unread)
  list(POP_FRONT unread file)
  file(STRINGS ${ROOT}/${file} includes REGEX "^#include \"[^\"]+\"")
  foreach(include IN LISTS includes)
    string(REGEX REPLACE "^#include \"([^\"]+)\".*" "\\1" name "${include}")
    foreach(folder src tests meshes)
      if(EXISTS ${ROOT}/${folder}/${name} AND NOT ${folder}/${name} IN_LIST files)
        list(APPEND files ${folder}/${name})
        list(APPEND unread ${folder}/${name})
      endif()
    endforeach()
  endforeach()
endwhile()
list(APPEND files .clang-tidy tests/.clang-tidy)
list(SORT files)

set(text "")
set(dependencies "")
foreach(file IN LISTS files)
  file(SHA256 ${ROOT}/${file} digest)
  string(APPEND text "${file} ${digest}\n")
  string(APPEND dependencies " ${ROOT}/${file}")
endforeach()
string(SHA256 digest "${text}")
set(entry "${digest} ${SOURCE}")

file(STRINGS ${RECORD} looked_at)
if(NOT entry IN_LIST looked_at)
  execute_process(COMMAND ${CLANG_TIDY} -p ${COMMANDS_FOLDER} --quiet ${ROOT}/${SOURCE} RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "clang-tidy does not pass ${SOURCE}")
  endif()
endif()
file(WRITE ${STAMP} "${entry}\n")
file(WRITE ${STAMP}.d "${STAMP}:${dependencies}\n")
