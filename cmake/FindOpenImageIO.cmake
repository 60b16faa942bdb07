# Debian's CONFIG packages cannot be used: OpenImageIO's asks for its tools and for an OpenCV folder, Imath's (whose
# headers those of OpenImageIO include) for the Python module, none of which need be there.
find_path(OpenImageIO_INCLUDE_DIR OpenImageIO/imageio.h)
find_path(OpenImageIO_Imath_INCLUDE_DIR Imath/half.h)
find_library(OpenImageIO_LIBRARY OpenImageIO)
find_library(OpenImageIO_Util_LIBRARY OpenImageIO_Util)
find_library(OpenImageIO_Imath_LIBRARY Imath)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenImageIO REQUIRED_VARS OpenImageIO_LIBRARY OpenImageIO_Util_LIBRARY
  OpenImageIO_Imath_LIBRARY OpenImageIO_INCLUDE_DIR OpenImageIO_Imath_INCLUDE_DIR)
if(OpenImageIO_FOUND AND NOT TARGET OpenImageIO::OpenImageIO)
  add_library(OpenImageIO::OpenImageIO UNKNOWN IMPORTED)
  set_target_properties(OpenImageIO::OpenImageIO PROPERTIES
    IMPORTED_LOCATION "${OpenImageIO_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${OpenImageIO_INCLUDE_DIR};${OpenImageIO_Imath_INCLUDE_DIR}"
    INTERFACE_LINK_LIBRARIES "${OpenImageIO_Util_LIBRARY};${OpenImageIO_Imath_LIBRARY}")
endif()
mark_as_advanced(OpenImageIO_INCLUDE_DIR OpenImageIO_Imath_INCLUDE_DIR OpenImageIO_LIBRARY OpenImageIO_Util_LIBRARY
  OpenImageIO_Imath_LIBRARY)
