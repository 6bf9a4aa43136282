# The command line. Each test is a function of a script in cli/, run in a folder of its own.
add_executable(json_get json_get.c)
target_link_libraries(json_get PRIVATE PkgConfig::jansson)

# A program with one wrong formula in its shader: `right` of shaders/FILE is `wrong` there.
function(add_broken_program name file right wrong)
    set(broken ${CMAKE_CURRENT_BINARY_DIR}/${name}_shader)
    file(READ ${PROJECT_SOURCE_DIR}/shaders/${file} text)
    string(REPLACE "${right}" "${wrong}" broken_text "${text}")
    if(broken_text STREQUAL text)
        message(FATAL_ERROR "${file} no longer has the formula that is to be broken")
    endif()
    file(CONFIGURE OUTPUT ${broken}/${file} CONTENT "${broken_text}" @ONLY)
    configure_file(${PROJECT_SOURCE_DIR}/shaders/whitted.comp ${broken}/whitted.comp COPYONLY)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/shaders/${file})
    foreach(variant whitted_exact whitted_exact_events)
        set(defines)
        if(variant MATCHES events)
            set(defines -DTRACE_EVENTS)
        endif()
        add_custom_command(
            OUTPUT ${broken}/${variant}.h
            COMMAND ${Vulkan_GLSLANG_VALIDATOR_EXECUTABLE} --quiet -V --target-env vulkan1.2 ${defines}
                    -I${PROJECT_SOURCE_DIR}/shaders --vn ${variant} -o ${broken}/${variant}.h ${broken}/whitted.comp
            DEPENDS ${broken}/${file} ${broken}/whitted.comp shader_headers
            COMMENT "Compiling ${name}/${variant}"
            VERBATIM)
    endforeach()
    add_executable(${name} ${PROJECT_SOURCE_DIR}/host/cli/main.c ${PROJECT_SOURCE_DIR}/host/tracer/whitted_spirv.c
                           ${broken}/whitted_exact.h ${broken}/whitted_exact_events.h)
    target_include_directories(${name} BEFORE PRIVATE ${broken} ${PROJECT_BINARY_DIR}/shaders)
    target_link_libraries(${name} PRIVATE vkwhitted_host)
endfunction()
# Oren-Nayar's B term by one part in 10000; Fresnel's k_r by a unit in the last place; total reflection too early; the
# end of shadow rays; normals by a unit in the last place.
add_broken_program(vkwhitted_broken shade.glsl "(matte.a + matte.b * sin_tan)"
                   "(matte.a + matte.b * sin_tan * real(1.0001))")
add_broken_program(vkwhitted_broken_k_r dielectric.glsl "return Refraction(total, reflectance,"
                   "return Refraction(total, intBitsToFloat(floatBitsToInt(reflectance) + 1),")
add_broken_program(vkwhitted_broken_total dielectric.glsl "total = !(cos_out_squared > real(0))"
                   "total = !(cos_out_squared > real(0.9))")
add_broken_program(vkwhitted_broken_shadow intersect.glsl " && approach.along < distance" "")
add_broken_program(vkwhitted_broken_normal intersect.glsl "facing_normal = hit.from_inside ? -normal : normal"
                   "facing_normal = intBitsToFloat(floatBitsToInt(hit.from_inside ? -normal : normal) + 1)")

# Wrong in the picture's pipeline, right in the one that records.
set(half ${CMAKE_CURRENT_BINARY_DIR}/vkwhitted_broken_picture_shader)
add_custom_command(
    OUTPUT ${half}/whitted_exact.h
    COMMAND ${CMAKE_COMMAND} -E copy ${CMAKE_CURRENT_BINARY_DIR}/vkwhitted_broken_k_r_shader/whitted_exact.h
            ${half}/whitted_exact.h
    DEPENDS ${CMAKE_CURRENT_BINARY_DIR}/vkwhitted_broken_k_r_shader/whitted_exact.h
    VERBATIM)
add_executable(vkwhitted_broken_picture ${PROJECT_SOURCE_DIR}/host/cli/main.c ${PROJECT_SOURCE_DIR}/host/tracer/whitted_spirv.c
                                        ${half}/whitted_exact.h)
target_include_directories(vkwhitted_broken_picture BEFORE PRIVATE ${half} ${PROJECT_BINARY_DIR}/shaders)
target_link_libraries(vkwhitted_broken_picture PRIVATE vkwhitted_host)

# A Vulkan layer that makes lavapipe look like a graphics card, and fail.
add_library(pretend_layer MODULE pretend_layer.c)
set_target_properties(pretend_layer PROPERTIES PREFIX "")
target_link_libraries(pretend_layer PRIVATE Vulkan::Headers)
configure_file(pretend_layer.json pretend_layer.json COPYONLY)

function(add_cli_tests script)
    foreach(name IN LISTS ARGN)
        add_test(NAME cli/${script}/${name} COMMAND bash ${CMAKE_CURRENT_SOURCE_DIR}/cli/${script}.sh ${name})
        set_tests_properties(
            cli/${script}/${name}
            PROPERTIES LABELS cli TIMEOUT 120 SKIP_RETURN_CODE 77
                       ENVIRONMENT "VKWHITTED=$<TARGET_FILE:vkwhitted>;BROKEN=$<TARGET_FILE:vkwhitted_broken>;\
JSON_GET=$<TARGET_FILE:json_get>;SOURCE_DIR=${PROJECT_SOURCE_DIR};\
BINARY_DIR=${PROJECT_BINARY_DIR};LAYER=${CMAKE_CURRENT_BINARY_DIR};SANITIZE=${VKWHITTED_SANITIZE}")
    endforeach()
endfunction()
add_cli_tests(usage no_command unknown_command unknown_option missing_argument value_like_an_option size numbers crop
              crop_outside option_of_another_command choices impossible_together several_scenes help_and_version
              manual_page completion)
add_cli_tests(input missing_scene folder_as_scene bad_scene bad_scene_among_good_ones scene_that_is_warned_of)
add_cli_tests(spheres bad_files arrays)
if(VKWHITTED_TESTS STREQUAL "all")
    add_cli_tests(spheres rows_as_objects names_of_rows)
endif()
add_cli_tests(output formats same_bits_on_both_backends exr_metadata transfer unknown_suffix unwritable_folder
              missing_folder disk_full existing_file_kept_on_failure crop_of_16384 stats)
add_cli_tests(device no_such_device device_by_name no_devices_at_all no_validation_layer
              devices)
if(VKWHITTED_TESTS STREQUAL "all")
    add_cli_tests(pretend failing_calls agreement_as_graphics_card dispatch_sizes agreement_with_long_vectors)
endif()
add_cli_tests(check agreement difference tolerance allow heatmap json)
add_cli_tests(picture right wrong_formula wrong_pixel refusals)
add_cli_tests(bench without_device bad_comparison options interrupted)
add_cli_tests(pixel against json light_samples place)
if(VKWHITTED_TESTS STREQUAL "all")
    add_cli_tests(check worst_status)
    add_cli_tests(bench report)
    add_cli_tests(pixel agreement samples max_bounces max_error options broken_k_r broken_shadow broken_normal broken_total broken_term broken_picture)
endif()
add_cli_tests(interrupt sigint_on_device sigint_on_cpu sigterm)
add_cli_tests(watch scene_edits_keep_the_pipeline broken_and_repaired missing_includes spheres_from_a_file
              checked_in_the_background device_lost)
add_cli_tests(progress on_a_terminal)
if(VKWHITTED_TESTS STREQUAL "all")
    add_cli_tests(watch saves shader_edits broken_at_the_start ways_of_saving written_slowly quick_saves idle checked_in_double
                  validated)
    add_cli_tests(progress not_elsewhere quiet)
endif()
if(VKWHITTED_SLOW_TESTS)
    add_cli_tests(bench files chart compare)
    set_tests_properties(cli/bench/files cli/bench/compare PROPERTIES TIMEOUT 400)
    add_cli_tests(output size_16384)
    set_tests_properties(cli/output/size_16384 PROPERTIES LABELS "cli;slow" TIMEOUT 900)
endif()
