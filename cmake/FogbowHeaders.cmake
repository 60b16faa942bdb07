# fogbow_common_headers(TARGET OWNER [HEADER...]): what nearly every file includes is parsed once, with OWNER, and not a
# second time a file: a third of the time of a build. Files include what they need all the same; CMAKE_DISABLE_PRECOMPILE_HEADERS
# (preset dev) shows whether they do.
function(fogbow_common_headers target owner)
  get_target_property(libraries ${target} LINK_LIBRARIES)
  if("CGAL::CGAL" IN_LIST libraries)
    return()  # compiled with -frounding-math, and so not what other files are compiled with
  elseif(target STREQUAL owner)
    target_precompile_headers(${target} PRIVATE <algorithm> <functional> <map> <memory> <string> <vector>
      ${CMAKE_SOURCE_DIR}/core/math/vec.h ${ARGN})
  else()
    target_precompile_headers(${target} REUSE_FROM ${owner})
  endif()
endfunction()
