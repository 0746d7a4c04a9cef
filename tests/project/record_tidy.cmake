# Writes to RECORD what the STAMPS that there are in FOLDER say: see tidy.cmake.
cmake_minimum_required(VERSION 3.25)

file(GLOB_RECURSE stamps ${FOLDER}/*.passed)
list(SORT stamps)
set(record "")
foreach(stamp IN LISTS stamps)
  file(READ ${stamp} entry)
  string(APPEND record "${entry}")
endforeach()
file(WRITE ${RECORD} "${record}")
