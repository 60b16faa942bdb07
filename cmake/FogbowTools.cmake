# Uses ccache and mold where present, unless the user chose a launcher or linker, or Fogbow is part of another project.
if(NOT PROJECT_IS_TOP_LEVEL)
  return()
endif()

if(NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
  find_program(CCACHE_PROGRAM ccache)
  if(CCACHE_PROGRAM)
    # What it must overlook to keep objects made with precompiled headers.
    set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE_PROGRAM})
  endif()
endif()

if(NOT CMAKE_EXE_LINKER_FLAGS MATCHES "-fuse-ld=")
  include(CheckLinkerFlag)
  check_linker_flag(CXX -fuse-ld=mold FOGBOW_HAS_MOLD)
  if(FOGBOW_HAS_MOLD)
    add_link_options(-fuse-ld=mold)
  endif()
endif()
