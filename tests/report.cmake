# What bench writes for people to look at.
add_executable(write_report write_report.c)
target_link_libraries(write_report PRIVATE vkwhitted_host)

foreach(name document_in_page unwritable browser)
    add_test(NAME cli/report/${name} COMMAND bash ${CMAKE_CURRENT_SOURCE_DIR}/cli/report.sh ${name})
    set_tests_properties(
        cli/report/${name} PROPERTIES LABELS cli TIMEOUT 120 SKIP_RETURN_CODE 77
                                      ENVIRONMENT "WRITE_REPORT=$<TARGET_FILE:write_report>;JSON_GET=$<TARGET_FILE:json_get>;SOURCE_DIR=${PROJECT_SOURCE_DIR}")
endforeach()
