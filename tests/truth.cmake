# The float picture against the exact one: errors, and no pixel that the error analysis (cpu_reference/NUMERICS.md)
# does not explain.
file(GLOB figure_scenes CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/scenes/*.yaml)
file(GLOB hard_scenes CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/scenes/hard/*.yaml)
file(GLOB test_scenes CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/scenes/*.yaml)

function(add_truth name scene precision)
    add_test(NAME truth/${name} COMMAND vkwhitted check -q --against ${precision} ${ARGN} ${scene})
    set_tests_properties(truth/${name} PROPERTIES LABELS truth TIMEOUT 600)
endfunction()

# The dear ones run in one of the builds: the same sources give the same bits in all (tests/elsewhere.cmake).
if(CMAKE_C_COMPILER_ID STREQUAL "GNU" AND NOT VKWHITTED_SANITIZE)
    set(dear_tests TRUE)
    set(truth_size)
else()
    set(dear_tests FALSE)
    set(truth_size --size 97x61)
endif()
foreach(scene IN LISTS figure_scenes hard_scenes test_scenes)
    cmake_path(GET scene STEM name)
    add_truth(${name} ${scene} double ${truth_size})
endforeach()
foreach(scene IN LISTS hard_scenes)
    cmake_path(GET scene STEM name)
    add_agreement(hard/${name} ${scene} ${truth_size})
endforeach()
if(NOT dear_tests)
    return()
endif()

foreach(scene IN LISTS figure_scenes)
    cmake_path(GET scene STEM name)
    add_truth(${name}/150x100/quad ${scene} quad --size 150x100)
    add_truth(${name}/97x61/bounces_16 ${scene} double --size 97x61 --max-bounces 16)
    add_truth(${name}/60x40/samples_4 ${scene} double --size 60x40 --samples 4)
endforeach()
foreach(scene IN LISTS hard_scenes)
    cmake_path(GET scene STEM name)
    add_truth(hard/${name}/60x40/quad ${scene} quad --size 60x40)
    add_truth(hard/${name}/97x61/bounces_16 ${scene} double --size 97x61 --max-bounces 16)
    add_agreement(hard/${name}/97x61/bounces_16 ${scene} --size 97x61 --max-bounces 16)
endforeach()

# What the README says of the figures' errors.
foreach(scene IN LISTS figure_scenes)
    cmake_path(GET scene STEM name)
    add_test(NAME truth/${name}/600x400/relative_error
             COMMAND ${CMAKE_COMMAND} -D vkwhitted=$<TARGET_FILE:vkwhitted> -D scene=${scene}
                     -D result=${CMAKE_CURRENT_BINARY_DIR}/truth_${name}.json -D largest_median=1.5e-7
                     -D largest_percentile_99_99=2e-4 -P ${CMAKE_CURRENT_SOURCE_DIR}/relative_error.cmake)
    set_tests_properties(truth/${name}/600x400/relative_error PROPERTIES LABELS truth TIMEOUT 900)
endforeach()
