# Tests of the project itself: the rules of the sources, and the installed package from a stranger's side.
find_package(Python3 REQUIRED COMPONENTS Interpreter)

add_test(NAME check_layers COMMAND ${Python3_EXECUTABLE} ${CMAKE_SOURCE_DIR}/scripts/check_layers.py ${CMAKE_SOURCE_DIR})
add_test(NAME check_layers_unittest COMMAND ${Python3_EXECUTABLE} -B ${CMAKE_SOURCE_DIR}/scripts/check_layers_test.py)

foreach(kind static shared)
  add_test(NAME consumer_${kind} COMMAND ${CMAKE_COMMAND}
    -DKIND=${kind} -DSOURCE_DIR=${CMAKE_SOURCE_DIR} -DBUILD_DIR=${CMAKE_BINARY_DIR} -DBUILD_SHARED_LIBS=${BUILD_SHARED_LIBS}
    -DBUILD_TYPE=${CMAKE_BUILD_TYPE} -DGENERATOR=${CMAKE_GENERATOR} -DCXX_COMPILER=${CMAKE_CXX_COMPILER}
    -DCXX_FLAGS=${CMAKE_CXX_FLAGS_RELWITHDEBINFO}
    -P ${CMAKE_SOURCE_DIR}/tests/consumer/build_and_run.cmake)
  set_tests_properties(consumer_${kind} PROPERTIES TIMEOUT 1800 PROCESSORS 2)
endforeach()
