# Writes to COMMANDS the compile commands of BINARY_FOLDER without headers that GCC compiled ahead, which clang-tidy cannot read.
cmake_minimum_required(VERSION 3.25)

file(READ ${BINARY_FOLDER}/compile_commands.json commands)
string(REGEX REPLACE " -Winvalid-pch -include [^\"]*cmake_pch.hxx" "" commands "${commands}")
file(WRITE ${COMMANDS} "${commands}")
