# cmake -D vkwhitted=PROGRAM -D scene=FILE -D result=FILE -D largest_median=X -D largest_percentile_99_99=X -P this:
# the relative errors of the scene's picture at 600x400 against double must be at most these, and 99 % of its pixels have a
# bound of at most 1e-2. (Binary128 gives the same
# digits, and takes a hundred times as long.)
execute_process(COMMAND ${vkwhitted} check -q --backend cpu --against double --size 600x400 --json ${result} ${scene}
                COMMAND_ERROR_IS_FATAL ANY)
file(READ ${result} json)
foreach(quantile median percentile_99_99)
    string(JSON error GET "${json}" scenes 0 relative_error ${quantile})
    message("relative error, ${quantile}: ${error}, at most ${largest_${quantile}}")
    if(NOT error LESS_EQUAL ${largest_${quantile}})
        message(SEND_ERROR "too large")
    endif()
endforeach()
string(JSON tight GET "${json}" scenes 0 tight_pixels)
message("pixels with a bound of at most 1e-2: ${tight}")
if(NOT tight GREATER 237600)
    message(SEND_ERROR "too few")
endif()
