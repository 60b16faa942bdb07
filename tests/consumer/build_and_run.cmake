# Installs Fogbow under BUILD_DIR/stage/KIND, builds this folder's project against it as any user would, and runs it.
set(stage ${BUILD_DIR}/stage/${KIND})
file(REMOVE_RECURSE ${stage})
set(toolchain -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${CXX_COMPILER} -DCMAKE_BUILD_TYPE=${BUILD_TYPE}
  -DCMAKE_CXX_FLAGS_RELWITHDEBINFO=${CXX_FLAGS})
if(KIND STREQUAL shared)
  set(want_shared ON)
else()
  set(want_shared OFF)
endif()

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

set(library_build ${BUILD_DIR})
if(NOT want_shared STREQUAL BUILD_SHARED_LIBS)
  # The other kind of library; ccache makes its objects from those of the main build.
  set(library_build ${stage}-build)
  run(${CMAKE_COMMAND} -S ${SOURCE_DIR} -B ${library_build} ${toolchain} -DBUILD_SHARED_LIBS=${want_shared} -DFOGBOW_BUILD_TESTS=OFF -DFOGBOW_BUILD_BENCHMARKS=OFF)
endif()
# Nothing to do for the main build, unless headers changed since: what is installed must fit together.
run(${CMAKE_COMMAND} --build ${library_build} --parallel 2 --target fogbow fogbow_image_io fogbow_cli)
run(${CMAKE_COMMAND} --install ${library_build} --prefix ${stage})
run(${CMAKE_COMMAND} -S ${SOURCE_DIR}/tests/consumer -B ${stage}/consumer --fresh ${toolchain} -DCMAKE_PREFIX_PATH=${stage})
run(${CMAKE_COMMAND} --build ${stage}/consumer)
run(${CMAKE_COMMAND} -E chdir ${stage}/consumer ./consumer)
