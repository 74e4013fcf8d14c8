# A test holds it to the version of the Python package.
set(PACKAGE_VERSION "0.1.0")

# Before 1.0, another minor version may be another interface.
string(REGEX MATCH "^[0-9]+\\.[0-9]+" _linkforge_series "${PACKAGE_VERSION}")
set(_linkforge_asked "${PACKAGE_FIND_VERSION_MAJOR}.${PACKAGE_FIND_VERSION_MINOR}")
if(PACKAGE_FIND_VERSION VERSION_GREATER PACKAGE_VERSION OR NOT _linkforge_asked STREQUAL _linkforge_series)
  set(PACKAGE_VERSION_COMPATIBLE FALSE)
else()
  set(PACKAGE_VERSION_COMPATIBLE TRUE)
endif()
if(PACKAGE_FIND_VERSION STREQUAL PACKAGE_VERSION)
  set(PACKAGE_VERSION_EXACT TRUE)
endif()
unset(_linkforge_series)
unset(_linkforge_asked)
