# SPDX-License-Identifier: GPL-3.0-or-later
# cmake -DOUTPUT=file.c "-DFILES=a;b" -P embed.cmake: writes the files as the table core/gl/shader_source.h declares.
set(arrays "")
set(rows "")
set(index 0)
foreach(file IN LISTS FILES)
  get_filename_component(name ${file} NAME)
  file(READ ${file} hex HEX)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${hex}")
  string(APPEND arrays "static const char file_${index}[] = {${bytes}0};\n")
  string(APPEND rows "    {\"${name}\", file_${index}},\n")
  math(EXPR index "${index} + 1")
endforeach()
string(APPEND rows "    {0, 0},\n")
file(WRITE ${OUTPUT}
    "#include \"gl/shader_source.h\"\n\n${arrays}\nconst struct shader_source shader_sources[] = {\n${rows}};\n")
