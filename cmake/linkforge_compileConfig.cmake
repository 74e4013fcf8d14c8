# find_package(linkforge_compile): the command `linkforge`, as LINKFORGE_EXECUTABLE, and linkforge_add_robot().

# 3.20 is the first in which Makefiles read a DEPFILE.
if(CMAKE_VERSION VERSION_LESS 3.20)
  set(${CMAKE_FIND_PACKAGE_NAME}_FOUND FALSE)
  set(${CMAKE_FIND_PACKAGE_NAME}_NOT_FOUND_MESSAGE "it needs CMake 3.20 or later, found ${CMAKE_VERSION}")
  return()
endif()

# What the functions do is not to depend on how old a CMake their caller asks for.
cmake_policy(VERSION 3.20)
# Empty text behind a keyword is a value; a newer CMake warns of one that takes it for nothing.
if(POLICY CMP0174)
  cmake_policy(SET CMP0174 NEW)
endif()

# pip puts this file into PREFIX/share/linkforge_compile/cmake, and the command into PREFIX/bin.
get_filename_component(_linkforge_prefix "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)
find_program(LINKFORGE_EXECUTABLE linkforge
  HINTS "${_linkforge_prefix}/bin" "${_linkforge_prefix}/Scripts"
  DOC "The compiler of robot specs")
unset(_linkforge_prefix)

if(NOT LINKFORGE_EXECUTABLE)
  set(${CMAKE_FIND_PACKAGE_NAME}_FOUND FALSE)
  set(${CMAKE_FIND_PACKAGE_NAME}_NOT_FOUND_MESSAGE
    "there is no command 'linkforge' beside it nor on the PATH; set LINKFORGE_EXECUTABLE")
  return()
endif()

include("${CMAKE_CURRENT_LIST_DIR}/linkforge_add_robot.cmake")
