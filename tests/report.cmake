# The page that bench writes, from a document with all that is awkward in it.
add_executable(write_report write_report.c)
target_link_libraries(write_report PRIVATE vkwhitted_host)
