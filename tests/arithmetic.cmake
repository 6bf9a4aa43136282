# Correctly rounded division and square root on devices that do not have them.
set(shaders ${PROJECT_SOURCE_DIR}/shaders)
file(GLOB shader_parts CONFIGURE_DEPENDS ${shaders}/*.comp ${shaders}/*.glsl ${shaders}/*.h)
function(add_test_shader folder name source)
    set(header ${CMAKE_CURRENT_BINARY_DIR}/${folder}/${name}.h)
    file(MAKE_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/${folder})
    add_custom_command(
        OUTPUT ${header}
        COMMAND ${Vulkan_GLSLANG_VALIDATOR_EXECUTABLE} --quiet -V --target-env vulkan1.2 ${ARGN} -I${shaders} --vn ${name}
                -o ${header} ${source}
        DEPENDS ${source} ${shader_parts}
        COMMENT "Compiling ${folder}/${name}"
        VERBATIM)
    set(${folder}_headers ${${folder}_headers} ${header} PARENT_SCOPE)
endfunction()

set(source ${CMAKE_CURRENT_SOURCE_DIR}/arithmetic.comp)
add_test_shader(arithmetic native ${source})
add_test_shader(arithmetic inexact ${source} -DINEXACT_NATIVE)
add_test_shader(arithmetic native_corrected ${source} -DCORRECTED)
add_test_shader(arithmetic far_corrected ${source} -DINEXACT_NATIVE -DDIVISION_ULPS=8 -DCORRECTED)
add_unit_test(arithmetic)
target_sources(unit_arithmetic PRIVATE ${arithmetic_headers})
target_include_directories(unit_arithmetic PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/arithmetic)

# The whole program on pretended devices: its own copies of the files that hold the shaders come before the
# library's.
set(host ${PROJECT_SOURCE_DIR}/host)
function(add_pretender name folder)
    add_executable(${name} ${host}/cli/main.c ${ARGN} ${${folder}_headers})
    target_include_directories(${name} PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/${folder} ${PROJECT_BINARY_DIR}/shaders)
    target_link_libraries(${name} PRIVATE vkwhitted_host)
endfunction()

add_test_shader(inexact whitted_exact ${shaders}/whitted.comp -DINEXACT_NATIVE)
add_test_shader(inexact whitted_exact_plain ${shaders}/whitted.comp -DINEXACT_NATIVE -DPLAIN)
add_test_shader(inexact whitted_corrected ${shaders}/whitted.comp -DINEXACT_NATIVE -DCORRECTED)
add_test_shader(inexact arithmetic_probe ${shaders}/probe.comp -DINEXACT_NATIVE)
add_pretender(vkwhitted_inexact inexact ${host}/tracer/whitted_spirv.c ${host}/vulkan/probe.c)
add_pretender(vkwhitted_misjudged inexact ${host}/tracer/whitted_spirv.c) # whose probe finds the true device
add_dependencies(vkwhitted_misjudged vkwhitted_inexact) # which makes the shared headers

# A device that adds c a little wrongly.
file(READ ${shaders}/probe.comp probe)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${shaders}/probe.comp)
string(REPLACE "a * b + c;" "a * b + c * 1.0000002;" contracting_probe "${probe}")
if(contracting_probe STREQUAL probe)
    message(FATAL_ERROR "probe.comp no longer has the expression that is to be spoilt")
endif()
file(CONFIGURE OUTPUT contracting_probe.comp CONTENT "${contracting_probe}" @ONLY)
add_test_shader(contracting arithmetic_probe ${CMAKE_CURRENT_BINARY_DIR}/contracting_probe.comp)
add_pretender(vkwhitted_contracting contracting ${host}/vulkan/probe.c)

set(size 300x200)
foreach(figure figure_2b figure_3c figure_4)
    set(scene ${PROJECT_SOURCE_DIR}/scenes/${figure}.yaml)
    add_test(NAME agreement/inexact_device/${figure}/${size}
             COMMAND vkwhitted_inexact check --validate ${scene} --size ${size} --samples 3 --light-samples 4)
    add_test(NAME agreement/inexact_device_uncorrected_differs/${figure}/${size}
             COMMAND sh -c "\"$0\" check \"$1\" --size ${size} --light-samples 4; test $? -eq 1"
                     $<TARGET_FILE:vkwhitted_misjudged> ${scene})
    set_tests_properties(agreement/inexact_device/${figure}/${size}
                         agreement/inexact_device_uncorrected_differs/${figure}/${size}
                         PROPERTIES LABELS agreement TIMEOUT 300)
endforeach()
# The probe judges another shader than the picture's: render compares some pixels, and writes no wrong picture.
add_test(NAME cli/render/misjudged_device
         COMMAND sh -c "rm -f misjudged.png; \"$0\" render \"$1\" -o misjudged.png 2>&1; test $? -eq 3 && ! test -e misjudged.png && echo refused"
                 $<TARGET_FILE:vkwhitted_misjudged> ${PROJECT_SOURCE_DIR}/scenes/figure_4.yaml)
set_tests_properties(cli/render/misjudged_device PROPERTIES LABELS cli PASS_REGULAR_EXPRESSION
                     "is not the reference's, although.*refused")
add_test(NAME cli/devices/inexact COMMAND vkwhitted_inexact devices --validate)
set_tests_properties(cli/devices/inexact PROPERTIES LABELS cli PASS_REGULAR_EXPRESSION
                     "arithmetic +÷ inexact, √ inexact, no contraction: corrected")
set(scene ${PROJECT_SOURCE_DIR}/scenes/figure_4.yaml)
add_test(NAME cli/contracting_device_is_refused
         COMMAND sh -c "\"$0\" check \"$1\" --size 60x40 2>&1; test $? -eq 3 && echo refused"
                 $<TARGET_FILE:vkwhitted_contracting> ${scene})
set_tests_properties(cli/contracting_device_is_refused PROPERTIES LABELS cli PASS_REGULAR_EXPRESSION
                     "cannot compute exactly: a \\* b \\+ c with .*--fast.*refused")
add_test(NAME cli/contracting_device_renders_fast
         COMMAND vkwhitted_contracting render ${scene} --fast --size 60x40 -q)
set_tests_properties(cli/contracting_device_renders_fast PROPERTIES LABELS cli)
