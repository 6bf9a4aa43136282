# The float picture judged by the exact one: errors, and no pixel that the error analysis (cpu_reference/NUMERICS.md)
# does not explain. The float picture is the reference's, which agreement/ holds the device to; the figures' is the device's.
function(add_judge name scene precision)
    add_test(NAME judge/${name} COMMAND vkwhitted check -q --against ${precision} ${ARGN} ${scene})
    set_tests_properties(judge/${name} PROPERTIES LABELS judge TIMEOUT 600)
endfunction()

if(VKWHITTED_TESTS STREQUAL "memory")
    foreach(scene IN LISTS figure_scenes hard_scenes)
        cmake_path(GET scene STEM name)
        add_judge(${name}/30x20 ${scene} double --size 30x20 --max-bounces 16 --backend cpu)
    endforeach()
    return()
endif()

foreach(scene IN LISTS figure_scenes hard_scenes test_scenes)
    cmake_path(GET scene STEM name)
    add_judge(${name}/150x100 ${scene} double --size 150x100 --backend cpu)
endforeach()
foreach(scene IN LISTS figure_scenes)
    cmake_path(GET scene STEM name)
    add_judge(${name}/97x61/quad ${scene} quad --size 97x61)
    add_judge(${name}/60x40/samples_4 ${scene} double --size 60x40 --samples 4 --backend cpu)
endforeach()
foreach(scene IN LISTS hard_scenes)
    cmake_path(GET scene STEM name)
    add_judge(${name}/60x40/quad ${scene} quad --size 60x40 --backend cpu)
endforeach()
foreach(scene IN LISTS hard_scenes)
    cmake_path(GET scene STEM name)
    add_judge(${name}/97x61/bounces_16 ${scene} double --size 97x61 --max-bounces 16 --backend cpu)
endforeach()

# What the README says of figure_4's errors.
foreach(scene IN LISTS figure_scenes)
    cmake_path(GET scene STEM name)
    add_test(NAME judge/${name}/600x400/relative_error
             COMMAND ${CMAKE_COMMAND} -D vkwhitted=$<TARGET_FILE:vkwhitted> -D scene=${scene}
                     -D result=${CMAKE_CURRENT_BINARY_DIR}/judge_${name}.json -D largest_median=1.5e-7
                     -D largest_percentile_99_99=2e-4 -P ${CMAKE_CURRENT_SOURCE_DIR}/relative_error.cmake)
    set_tests_properties(judge/${name}/600x400/relative_error PROPERTIES LABELS judge TIMEOUT 900)
endforeach()
