# Installs the browser's driver for the tests of the page, unless it is there: cmake -D FROM=FOLDER -D TO=FOLDER -D NPM=PROGRAM -P ...
# Without a network the tests of the page are skipped.
file(READ ${FROM}/package-lock.json lock)
set(installed "")
if(EXISTS ${TO}/installed)
  file(READ ${TO}/installed installed)
endif()
if(NOT installed STREQUAL lock)
  file(COPY ${FROM}/package.json ${FROM}/package-lock.json DESTINATION ${TO})
  execute_process(COMMAND ${NPM} ci --ignore-scripts --no-audit --no-fund --loglevel=error WORKING_DIRECTORY ${TO} RESULT_VARIABLE failed)
  if(NOT failed)
    file(WRITE ${TO}/installed "${lock}")
  endif()
endif()
