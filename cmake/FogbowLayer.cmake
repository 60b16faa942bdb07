# fogbow_layer(NAME SOURCES... [LIBRARIES...]): one object library a layer, all of them linked into `fogbow`.
# LIBRARIES are private: headers of a layer include none of them.
function(fogbow_layer name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBRARIES" ${ARGN})
  add_library(fogbow_${name} OBJECT ${ARG_SOURCES})
  set_target_properties(fogbow_${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_compile_options(fogbow_${name} PRIVATE ${FOGBOW_OBJECT_OPTIONS})
  target_link_libraries(fogbow_${name} PUBLIC fogbow_options PRIVATE ${ARG_LIBRARIES})
  fogbow_common_headers(fogbow_${name} fogbow_math)
  set_property(GLOBAL APPEND PROPERTY FOGBOW_LAYERS fogbow_${name})
  set_property(GLOBAL APPEND PROPERTY FOGBOW_LIBRARIES ${ARG_LIBRARIES})
endfunction()
