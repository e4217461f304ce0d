# SPDX-License-Identifier: GPL-3.0-or-later
# cmake -DVERSION= -DSTAGE= -DZIP= -DLIBRARY= -DFILES= -P package.cmake: puts the add-on's folder into a zip.
file(REMOVE_RECURSE ${STAGE}/penumbra)
file(COPY ${FILES} ${LIBRARY} DESTINATION ${STAGE}/penumbra)

# The sources carry version 0.0.0 in these two places.
string(REPLACE "." ", " tuple ${VERSION})
foreach(line "__init__.py|(0, 0, 0),  # set by the build|(${tuple}),"
             "blender_manifest.toml|\"0.0.0\"  # set by the build|\"${VERSION}\"")
  string(REPLACE "|" ";" parts "${line}")
  list(GET parts 0 name)
  list(GET parts 1 from)
  list(GET parts 2 to)
  file(READ ${STAGE}/penumbra/${name} text)
  string(FIND "${text}" "${from}" place)
  if(place EQUAL -1)
    message(FATAL_ERROR "${name} has no version to set")
  endif()
  string(REPLACE "${from}" "${to}" text "${text}")
  file(WRITE ${STAGE}/penumbra/${name} "${text}")
endforeach()

# A fixed time and a sorted list make equal contents equal files.
file(REMOVE ${ZIP})
file(GLOB staged RELATIVE ${STAGE} ${STAGE}/penumbra/*)
execute_process(
  COMMAND ${CMAKE_COMMAND} -E tar cf ${ZIP} --format=zip --mtime=2000-01-01 ${staged}
  WORKING_DIRECTORY ${STAGE}
  COMMAND_ERROR_IS_FATAL ANY)
