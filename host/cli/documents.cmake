# cmake -D PROGRAM=... -D SOURCE=... -D BINARY=... -P documents.cmake
#
# What the program says of its options with --help goes into the manual page, as option sections, and into the
# completions of the shells, as it is: SOURCE/*.in become BINARY/vkwhitted.1 and BINARY/completions/.
execute_process(COMMAND ${PROGRAM} --help OUTPUT_VARIABLE help COMMAND_ERROR_IS_FATAL ANY)

# A section is the names of commands and a colon; then options: two spaces, names and value, at least two spaces,
# text; further lines of it are indented.
string(REGEX REPLACE "^usage:([^\n]+\n)+|\nexit status.*" "" options "${help}")
string(REGEX REPLACE "\n   +" "\n" options "${options}")
string(REGEX REPLACE "\n\n([^\n]+):\n" "\n.El\n.Ss \\1\n.Bl -tag -width Ds\n" options "\n${options}.El")
string(REGEX REPLACE "^\n.El\n" "" options "${options}")
string(REGEX REPLACE "\n  -(.), -" "\n  -\\1 , Fl " options "${options}")
string(REGEX REPLACE "\n  -([a-z-]+) ([^ ,\n][^ \n]*)  +" "\n.It Fl \\1 Ar \\2\n" options "${options}")
string(REGEX REPLACE "\n  -([a-z-]+( , Fl [a-z-]+)?)  +" "\n.It Fl \\1\n" options "${options}")
string(REPLACE "--" "\\-\\-" options "${options}") # left of those in texts
string(REGEX REPLACE "\n(')" "\n\\\\&\\1" options "${options}") # no macro

foreach(file vkwhitted.1 completions/bash/vkwhitted completions/zsh/_vkwhitted)
    configure_file(${SOURCE}/${file}.in ${BINARY}/${file} @ONLY)
    file(TOUCH ${BINARY}/${file}) # it may be the same as before
endforeach()
