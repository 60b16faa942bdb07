# The installed package: find_package(Fogbow [COMPONENTS image_io]) gives Fogbow::fogbow and Fogbow::image_io.
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/Fogbow)

set_target_properties(fogbow fogbow_image_io PROPERTIES VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set_target_properties(fogbow_image_io PROPERTIES EXPORT_NAME image_io)
install(TARGETS fogbow fogbow_image_io EXPORT FogbowTargets)
install(TARGETS fogbow_cli)
install(EXPORT FogbowTargets NAMESPACE Fogbow:: DESTINATION ${package_dir})

# Headers name each other from the root of the sources, which is include/fogbow once installed.
install(DIRECTORY core media mlt DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/fogbow FILES_MATCHING PATTERN "*.h")
install(FILES include/fogbow/fogbow.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/fogbow)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})

configure_package_config_file(cmake/FogbowConfig.cmake.in FogbowConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(FogbowConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/FogbowConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/FogbowConfigVersion.cmake
  cmake/FindBlosc.cmake cmake/FindOpenImageIO.cmake DESTINATION ${package_dir})
