# linkforge_add_robot(SPEC
#   [PARAMS NAME:=VALUE ...]      # its parameters; a relative file among them starts in the build folder
#   [VARIANT NAME]                # one of its variants; no text is no variant
#   [PACKAGES NAME=FOLDER ...]    # where package://NAME/ is, before any other place
#   [ALLOW_OUTSIDE]               # lets it read files outside its package, as --allow-outside does
#   [GAZEBO gz|classic]           # the simulator that reads the sensors
#   [FORMATS urdf srdf]           # what to write; urdf unless said
#   [NAME NAME]                   # NAME.urdf and NAME.srdf in the build folder; the spec's name unless said. Folders in
#                                 # it are those of the installation as well
#   [TARGET TARGET]               # the target, which is part of `all`; robot_NAME unless said
#   [OUTPUT VARIABLE]             # where to leave the paths of what is written
#   [INSTALL [DESTINATION DIR]])  # into share/PROJECT/DIR, or DIR itself from share/ on or absolute; urdf unless said
#
# Compiles a robot whenever the spec changes, or anything that it is made from: modules, included files, files of
# values, xacro files and meshes that give an inertia, as the compile itself says, and linkforge.
function(linkforge_add_robot spec)
  set(call "linkforge_add_robot(${spec})")
  set(rename "call the files of this one by NAME")
  cmake_parse_arguments(PARSE_ARGV 1 ROBOT
    "INSTALL;ALLOW_OUTSIDE" "VARIANT;GAZEBO;NAME;TARGET;OUTPUT;DESTINATION" "PARAMS;PACKAGES;FORMATS")
  if(ROBOT_UNPARSED_ARGUMENTS)
    list(GET ROBOT_UNPARSED_ARGUMENTS 0 word)
    set(taken "PARAMS, VARIANT, PACKAGES, ALLOW_OUTSIDE, GAZEBO, FORMATS, NAME, TARGET, OUTPUT, INSTALL and DESTINATION")
    _linkforge_refuse("it has no argument '${word}'; it takes ${taken}")
  endif()
  _linkforge_check_keywords()
  get_filename_component(path "${spec}" ABSOLUTE)
  _linkforge_require_spec()
  if(NOT DEFINED ROBOT_NAME)
    _linkforge_name(ROBOT_NAME)
  endif()
  _linkforge_require_name()
  if(NOT DEFINED ROBOT_TARGET)
    string(REGEX REPLACE "[^A-Za-z0-9_.+-]" "_" ROBOT_TARGET "robot_${ROBOT_NAME}")
  endif()
  _linkforge_destination(destination)
  _linkforge_options(options)
  _linkforge_outputs(outputs)
  _linkforge_require_target()

  list(TRANSFORM outputs PREPEND "-o;" OUTPUT_VARIABLE output_options)
  _linkforge_compile("${ROBOT_NAME}.robot.d" "Compiling robot ${ROBOT_NAME}" "${path}" "${outputs}")
  if(DEFINED ROBOT_OUTPUT)
    set(${ROBOT_OUTPUT} ${outputs} PARENT_SCOPE)
  endif()
endfunction()

# linkforge_add_robots(SPEC ...
#   TARGET TARGET                 # the target of all, which is part of `all`
#   [PARAMS ...] [VARIANT NAME] [PACKAGES ...] [ALLOW_OUTSIDE] [GAZEBO gz|classic] [FORMATS urdf srdf]
#   [OUTPUT VARIABLE] [INSTALL [DESTINATION DIR]])      # as above, for each of them
#
# Compiles several robots in one process, whenever any of them or of what they are made from changes. An output whose
# bytes stay the same keeps its time stamp, so that with Ninja nothing that depends on it is built again.
function(linkforge_add_robots)
  cmake_parse_arguments(PARSE_ARGV 0 ROBOT
    "INSTALL;ALLOW_OUTSIDE" "VARIANT;GAZEBO;TARGET;OUTPUT;DESTINATION" "PARAMS;PACKAGES;FORMATS")
  set(call "linkforge_add_robots(TARGET ${ROBOT_TARGET})")
  set(rename "add this one by linkforge_add_robot, with a NAME")
  _linkforge_check_keywords()
  if(NOT ROBOT_UNPARSED_ARGUMENTS)
    _linkforge_refuse("it takes one spec or more before its keywords")
  endif()
  if(NOT DEFINED ROBOT_TARGET)
    _linkforge_refuse("TARGET is missing, the name of the target of all these robots")
  endif()
  set(paths)
  set(all_outputs)
  foreach(spec IN LISTS ROBOT_UNPARSED_ARGUMENTS)
    get_filename_component(path "${spec}" ABSOLUTE)
    _linkforge_require_spec()
    _linkforge_name(ROBOT_NAME)
    _linkforge_outputs(outputs)
    list(APPEND paths "${path}")
    list(APPEND all_outputs ${outputs})
  endforeach()
  _linkforge_require_target()
  set(outputs "${all_outputs}")
  _linkforge_destination(destination)
  _linkforge_options(options)

  set(output_options -o "${CMAKE_CURRENT_BINARY_DIR}/")
  foreach(format IN LISTS ROBOT_FORMATS)
    list(APPEND output_options --format "${format}")
  endforeach()
  _linkforge_compile("${ROBOT_TARGET}.robots.d" "Compiling robots ${ROBOT_TARGET}" "${paths}" "${outputs}")
  if(DEFINED ROBOT_OUTPUT)
    set(${ROBOT_OUTPUT} ${outputs} PARENT_SCOPE)
  endif()
endfunction()

# The functions below see the variables of the one that calls them.

# Run one process that compiles specs into outputs, as part of ROBOT_TARGET, and install these.
function(_linkforge_compile depfile comment specs outputs)
  set(depfile "${CMAKE_CURRENT_BINARY_DIR}/${depfile}")
  # Outputs whose bytes stay keep their time stamp. Ninja knows; Make would compile again and again.
  set(renew)
  if(CMAKE_GENERATOR MATCHES "Makefiles")
    set(renew COMMAND "${CMAKE_COMMAND}" -E touch ${outputs})
  endif()
  add_custom_command(
    OUTPUT ${outputs}
    COMMAND "${LINKFORGE_EXECUTABLE}" compile ${specs} ${options} ${output_options} --depfile "${depfile}"
    ${renew}
    DEPENDS ${specs}
    DEPFILE "${depfile}"
    COMMENT "${comment}"
    VERBATIM)
  add_custom_target("${ROBOT_TARGET}" ALL DEPENDS ${outputs} SOURCES ${specs})
  if(ROBOT_INSTALL)
    _linkforge_require_places()
    install(FILES ${outputs} DESTINATION "${destination}")
  endif()
endfunction()

function(_linkforge_refuse why)
  message(FATAL_ERROR "${call}: ${why}")
endfunction()

# Check the keywords that both functions have; an empty value is none.
macro(_linkforge_check_keywords)
  # A variable behind PARAMS, VARIANT or PACKAGES may well be empty.
  list(FILTER ROBOT_KEYWORDS_MISSING_VALUES EXCLUDE REGEX "^(PARAMS|VARIANT|PACKAGES)$")
  if(ROBOT_KEYWORDS_MISSING_VALUES)
    _linkforge_refuse("nothing is said behind ${ROBOT_KEYWORDS_MISSING_VALUES}")
  endif()
  # An empty text says nothing, as CMake before 3.31 has it for all.
  foreach(word IN ITEMS VARIANT GAZEBO NAME TARGET OUTPUT DESTINATION)
    if("${ROBOT_${word}}" STREQUAL "")
      unset(ROBOT_${word})
    endif()
  endforeach()
  if(DEFINED ROBOT_DESTINATION AND NOT ROBOT_INSTALL)
    _linkforge_refuse("DESTINATION is of INSTALL, which is not there")
  endif()
  if(NOT DEFINED ROBOT_FORMATS)
    set(ROBOT_FORMATS urdf)
  endif()
  list(REMOVE_DUPLICATES ROBOT_FORMATS)
endmacro()

# The name of the outputs of a spec.
function(_linkforge_name result)
  get_filename_component(name "${path}" NAME)
  # The endings of name_of in linkforge_compile/cli/targets.py, in its order.
  foreach(ending IN ITEMS yaml yml robot xacro urdf)
    string(REGEX REPLACE "\\.${ending}$" "" name "${name}")
  endforeach()
  set(${result} "${name}" PARENT_SCOPE)
endfunction()

function(_linkforge_require_target)
  if(TARGET "${ROBOT_TARGET}")
    _linkforge_refuse("there is a target '${ROBOT_TARGET}' already; call that of this one by TARGET")
  endif()
endfunction()

function(_linkforge_require_spec)
  if(path MATCHES ";")
    _linkforge_refuse("CMake cannot depend on '${path}', for it has ';' in it; rename it")
  endif()
  # One that another command makes comes with the build.
  get_source_file_property(is_generated "${path}" GENERATED)
  if(IS_DIRECTORY "${path}" OR NOT (is_generated OR EXISTS "${path}"))
    _linkforge_refuse("there is no spec '${path}'")
  endif()
endfunction()

function(_linkforge_require_name)
  set(file "${ROBOT_NAME}")
  cmake_path(NORMAL_PATH file)
  # Each has one spelling, by which another one is found to have it.
  if(NOT file STREQUAL ROBOT_NAME OR IS_ABSOLUTE "${file}" OR file MATCHES "^$|^\\.\\.?(/|$)|/$")
    _linkforge_refuse("NAME is that of files in the build folder, without their ending; found '${ROBOT_NAME}'")
  endif()
endfunction()

function(_linkforge_require_places)
  get_property(others GLOBAL PROPERTY linkforge_installed)
  foreach(output IN LISTS outputs)
    cmake_path(GET output FILENAME file)
    cmake_path(APPEND destination "${file}" OUTPUT_VARIABLE place)
    cmake_path(ABSOLUTE_PATH place BASE_DIRECTORY "${CMAKE_INSTALL_PREFIX}" NORMALIZE)
    if(place IN_LIST others)
      _linkforge_refuse(
        "another one installs '${place}' already; ${rename}, or call their folder by DESTINATION")
    endif()
    set_property(GLOBAL APPEND PROPERTY linkforge_installed "${place}")
  endforeach()
endfunction()

function(_linkforge_options result)
  set(options)
  foreach(parameter IN LISTS ROBOT_PARAMS)
    # A keyword that is misspelt behind PARAMS is one of them.
    if(NOT parameter MATCHES "^[^=]+=")
      _linkforge_refuse("PARAMS takes NAME:=VALUE, found '${parameter}'")
    endif()
    string(REPLACE ";" "\\;" parameter "${parameter}")
    list(APPEND options -p "${parameter}")
  endforeach()
  foreach(pair IN LISTS ROBOT_PACKAGES)
    if(NOT pair MATCHES "^([^=]+)=(.+)$")
      _linkforge_refuse("PACKAGES takes NAME=FOLDER, found '${pair}'")
    endif()
    set(name "${CMAKE_MATCH_1}")
    get_filename_component(folder "${CMAKE_MATCH_2}" ABSOLUTE)
    if(NOT IS_DIRECTORY "${folder}")
      _linkforge_refuse("PACKAGES ${pair}: there is no folder '${folder}'")
    endif()
    list(APPEND options --package "${name}=${folder}")
  endforeach()
  if(ROBOT_ALLOW_OUTSIDE)
    list(APPEND options --allow-outside)
  endif()
  if(DEFINED ROBOT_VARIANT)
    list(APPEND options --variant "${ROBOT_VARIANT}")
  endif()
  if(DEFINED ROBOT_GAZEBO)
    if(NOT ROBOT_GAZEBO MATCHES "^(gz|classic)$")
      _linkforge_refuse("GAZEBO takes gz or classic, found '${ROBOT_GAZEBO}'")
    endif()
    list(APPEND options --gazebo "${ROBOT_GAZEBO}")
  endif()
  # The installation is laid out as the source tree, so that is where relative paths of meshes are looked for.
  set(share "share/${PROJECT_NAME}")
  cmake_path(IS_PREFIX share "${destination}" NORMALIZE is_of_project)
  if(ROBOT_INSTALL AND is_of_project)
    cmake_path(RELATIVE_PATH destination BASE_DIRECTORY "${share}")
    list(APPEND options --installed-in "${PROJECT_SOURCE_DIR}/${destination}")
  endif()
  set(${result} "${options}" PARENT_SCOPE)
endfunction()

function(_linkforge_outputs result)
  get_property(others DIRECTORY PROPERTY linkforge_outputs)
  set(outputs)
  # A test holds it to the formats of the Python package whose suffix is their name.
  set(formats urdf srdf mjcf sdf)
  list(JOIN formats ", " names)
  foreach(format IN LISTS ROBOT_FORMATS)
    if(NOT format IN_LIST formats)
      _linkforge_refuse("FORMATS takes ${names}, found '${format}'")
    endif()
    set(output "${CMAKE_CURRENT_BINARY_DIR}/${ROBOT_NAME}.${format}")
    if(output IN_LIST others)
      _linkforge_refuse("another one makes ${ROBOT_NAME}.${format} already; ${rename}")
    endif()
    list(APPEND outputs "${output}")
  endforeach()
  set_property(DIRECTORY APPEND PROPERTY linkforge_outputs ${outputs})
  set(${result} "${outputs}" PARENT_SCOPE)
endfunction()

function(_linkforge_destination result)
  set(destination urdf)
  if(DEFINED ROBOT_DESTINATION)
    set(destination "${ROBOT_DESTINATION}")
  endif()
  if(NOT IS_ABSOLUTE "${destination}" AND NOT destination MATCHES "^share/")
    set(destination "share/${PROJECT_NAME}/${destination}")
  endif()
  get_filename_component(folder "${ROBOT_NAME}" DIRECTORY)
  if(NOT folder STREQUAL "")
    cmake_path(APPEND destination "${folder}")
  endif()
  set(${result} "${destination}" PARENT_SCOPE)
endfunction()
