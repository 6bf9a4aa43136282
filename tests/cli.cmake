# The command line. Each test is a function of a script in cli/, run in a folder of its own.
add_executable(json_get json_get.c)
target_link_libraries(json_get PRIVATE PkgConfig::jansson)

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
                       ENVIRONMENT "VKWHITTED=$<TARGET_FILE:vkwhitted>;\
JSON_GET=$<TARGET_FILE:json_get>;SOURCE_DIR=${PROJECT_SOURCE_DIR};\
BINARY_DIR=${PROJECT_BINARY_DIR};LAYER=${CMAKE_CURRENT_BINARY_DIR};SANITIZE=${VKWHITTED_SANITIZE}")
    endforeach()
endfunction()
add_cli_tests(usage no_command unknown_command unknown_option missing_argument value_like_an_option size numbers crop
              crop_outside option_of_another_command choices impossible_together several_scenes help_and_version
              manual_page completion)
add_cli_tests(input missing_scene scene_by_name folder_as_scene bad_scene bad_scene_among_good_ones scene_that_is_warned_of
              scene_beyond_float)
add_cli_tests(spheres bad_files arrays)
if(VKWHITTED_TESTS STREQUAL "all")
    add_cli_tests(spheres rows_as_objects names_of_rows coincident_20000)
endif()
add_cli_tests(output formats same_bits_on_both_backends exr_metadata transfer unknown_suffix unwritable_folder
              missing_folder disk_full existing_file_kept_on_failure crop_of_16384 stats)
add_cli_tests(device no_such_device device_by_name no_devices_at_all no_validation_layer
              devices)
if(VKWHITTED_TESTS STREQUAL "all")
    add_cli_tests(pretend failing_calls texel_limit agreement_as_graphics_card dispatch_sizes agreement_with_long_vectors)
endif()
add_cli_tests(check agreement difference tolerance allow heatmap json junit)
add_cli_tests(picture right wrong_formula wrong_pixel refusals)
add_cli_tests(bench without_device bad_comparison options)
add_cli_tests(pixel against json light_samples place)
if(VKWHITTED_TESTS STREQUAL "all")
    add_cli_tests(check worst_status judged_behind_a_lens)
    add_cli_tests(package deb)
    add_cli_tests(readme commands sessions files)
    add_cli_tests(bench report)
    add_cli_tests(pixel agreement samples max_bounces max_error options broken_k_r broken_shadow broken_normal broken_total broken_term broken_picture)
endif()
add_cli_tests(interrupt writing fifo)
add_cli_tests(hostile escapes)
if(VKWHITTED_TESTS STREQUAL "all")
    add_cli_tests(interrupt render_on_cpu render_on_device check bench pixel watch packing ignored)
    add_cli_tests(hostile eaten_inputs closed_streams results_at_the_end limits large_files)
endif()
add_cli_tests(watch scene_edits_keep_the_pipeline broken_and_repaired missing_includes spheres_from_a_file
              checked_in_the_background device_lost)
add_cli_tests(progress on_a_terminal)
if(VKWHITTED_TESTS STREQUAL "all")
    add_cli_tests(watch camera_among_many_spheres saves shader_edits broken_at_the_start ways_of_saving written_slowly quick_saves idle checked_in_double
                  validated)
    add_cli_tests(progress inside_tiles minutes not_elsewhere quiet)
endif()
add_cli_tests(join tiles refusals usage damaged)
if(NOT VKWHITTED_SANITIZE) # which reserves terabytes
    add_cli_tests(join larger_than_memory)
endif()

# Programs that read EXR files. ./bootstrap --test installs the first; those that are not there are listed as disabled.
function(add_reader_test name program)
    find_program(VKWHITTED_READER_${name} NAMES ${ARGN} ${program})
    set(tool ${VKWHITTED_READER_${name}})
    add_cli_tests(exr ${name})
    set_property(TEST cli/exr/${name} APPEND PROPERTY ENVIRONMENT TOOL=${tool})
    if(NOT tool)
        set_tests_properties(cli/exr/${name} PROPERTIES DISABLED ON)
    endif()
endfunction()
if(VKWHITTED_TESTS STREQUAL "all")
    add_reader_test(exrinfo exrinfo)
    add_reader_test(openimageio oiiotool)
    add_reader_test(imagemagick convert-im6.q16 magick)
    add_reader_test(ffmpeg ffmpeg)
    find_program(VKWHITTED_SYSTEM_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH)
    execute_process(COMMAND ${VKWHITTED_SYSTEM_PYTHON} -c "import cv2" RESULT_VARIABLE no_opencv OUTPUT_QUIET ERROR_QUIET)
    if(no_opencv)
        add_reader_test(opencv no-opencv)
    else()
        add_reader_test(opencv no-opencv ${VKWHITTED_SYSTEM_PYTHON})
    endif()
endif()

# A Slurm of one machine. Debian: slurm-wlm munge.
find_program(VKWHITTED_SLURMCTLD slurmctld PATHS /usr/sbin)
find_program(VKWHITTED_MUNGED munged PATHS /usr/sbin)
if(VKWHITTED_SLOW_TESTS AND NOT (VKWHITTED_SLURMCTLD AND VKWHITTED_MUNGED))
    message(FATAL_ERROR "VKWHITTED_SLOW_TESTS needs Slurm: apt-get install slurm-wlm munge")
endif()
add_test(NAME slurm COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/slurm.sh $<TARGET_FILE:vkwhitted> ${PROJECT_SOURCE_DIR})
set_tests_properties(slurm PROPERTIES LABELS "cli;slow" TIMEOUT 300)
if(NOT VKWHITTED_SLOW_TESTS)
    set_tests_properties(slurm PROPERTIES DISABLED ON)
endif()
if(VKWHITTED_SLOW_TESTS)
    add_cli_tests(spheres million_grains)
    add_cli_tests(bench files chart compare)
    set_tests_properties(cli/bench/files cli/bench/compare PROPERTIES TIMEOUT 400)
    add_cli_tests(output size_16384)
    set_tests_properties(cli/output/size_16384 PROPERTIES LABELS "cli;slow" TIMEOUT 900)
endif()
