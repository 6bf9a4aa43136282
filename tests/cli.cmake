# The command line. Each test is a function of a script in cli/, run in a folder of its own.
add_executable(json_get json_get.c)
target_link_libraries(json_get PRIVATE PkgConfig::jansson)

# A program whose shader has one wrong formula: Oren-Nayar's B term by one part in 10000.
set(broken ${CMAKE_CURRENT_BINARY_DIR}/broken)
file(READ ${PROJECT_SOURCE_DIR}/shaders/shade.glsl shade)
string(REPLACE "(matte.a + matte.b * sin_tan)" "(matte.a + matte.b * sin_tan * real(1.0001))" broken_shade "${shade}")
if(broken_shade STREQUAL shade)
    message(FATAL_ERROR "shade.glsl no longer has the formula that is to be broken")
endif()
file(CONFIGURE OUTPUT ${broken}/shade.glsl CONTENT "${broken_shade}" @ONLY)
configure_file(${PROJECT_SOURCE_DIR}/shaders/whitted.comp ${broken}/whitted.comp COPYONLY)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/shaders/shade.glsl)
add_custom_command(
    OUTPUT ${broken}/whitted_exact.h
    COMMAND ${Vulkan_GLSLANG_VALIDATOR_EXECUTABLE} --quiet -V --target-env vulkan1.2 -I${PROJECT_SOURCE_DIR}/shaders
            --vn whitted_exact -o ${broken}/whitted_exact.h ${broken}/whitted.comp
    DEPENDS ${broken}/shade.glsl ${broken}/whitted.comp shader_headers
    COMMENT "Compiling broken/whitted_exact"
    VERBATIM)
add_executable(vkwhitted_broken ${PROJECT_SOURCE_DIR}/host/main.c ${PROJECT_SOURCE_DIR}/host/whitted_spirv.c
                                ${broken}/whitted_exact.h)
target_include_directories(vkwhitted_broken BEFORE PRIVATE ${broken} ${PROJECT_BINARY_DIR}/shaders)
target_link_libraries(vkwhitted_broken PRIVATE vkwhitted_host)

function(add_cli_tests script)
    foreach(name IN LISTS ARGN)
        add_test(NAME cli/${script}/${name} COMMAND bash ${CMAKE_CURRENT_SOURCE_DIR}/cli/${script}.sh ${name})
        set_tests_properties(
            cli/${script}/${name}
            PROPERTIES LABELS cli TIMEOUT 120 SKIP_RETURN_CODE 77
                       ENVIRONMENT "VKWHITTED=$<TARGET_FILE:vkwhitted>;BROKEN=$<TARGET_FILE:vkwhitted_broken>;\
JSON_GET=$<TARGET_FILE:json_get>;SOURCE_DIR=${PROJECT_SOURCE_DIR};SANITIZE=${VKWHITTED_SANITIZE}")
    endforeach()
endfunction()
add_cli_tests(usage no_command unknown_command unknown_option missing_argument size numbers crop crop_outside
              option_of_another_command choices impossible_together several_scenes help_and_version)
add_cli_tests(input missing_scene folder_as_scene bad_scene bad_scene_among_good_ones)
add_cli_tests(output formats same_bits_on_both_backends exr_metadata transfer unknown_suffix unwritable_folder
              missing_folder disk_full existing_file_kept_on_failure crop_of_16384 stats)
add_cli_tests(device no_such_device device_by_name no_devices_at_all no_validation_layer loops_ended_early
              devices)
add_cli_tests(check agreement difference tolerance allow heatmap json worst_status)
add_cli_tests(bench files without_device report compare bad_comparison options interrupted)
set_tests_properties(cli/bench/files cli/bench/compare PROPERTIES TIMEOUT 400)
add_cli_tests(interrupt sigint_on_device sigint_on_cpu sigterm)
add_cli_tests(progress on_a_terminal not_elsewhere quiet)
if(VKWHITTED_SLOW_TESTS)
    add_cli_tests(output size_16384)
    set_tests_properties(cli/output/size_16384 PROPERTIES LABELS "cli;slow" TIMEOUT 900)
endif()
