# The window, on X servers that the tests start and kill.
pkg_check_modules(x11 REQUIRED IMPORTED_TARGET x11)
foreach(name window input watch)
    add_executable(display_${name} display_${name}.c)
    target_include_directories(display_${name} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
    target_compile_definitions(display_${name} PRIVATE SOURCE_DIR="${PROJECT_SOURCE_DIR}" VKWHITTED="$<TARGET_FILE:vkwhitted>")
    target_link_libraries(display_${name} PRIVATE vkwhitted_host PkgConfig::cmocka PkgConfig::x11)
    add_test(NAME display/${name} COMMAND display_${name})
    set_tests_properties(display/${name} PROPERTIES LABELS display TIMEOUT 300)
    if(VKWHITTED_TEST_ELSEWHERE AND NOT name STREQUAL "watch") # whose pipelines take SwiftShader half a minute
        add_test(NAME elsewhere/swiftshader/display_${name} COMMAND display_${name})
        set_tests_properties(elsewhere/swiftshader/display_${name} PROPERTIES LABELS elsewhere TIMEOUT 300
                             ENVIRONMENT "${swiftshader}")
    endif()
endforeach()
