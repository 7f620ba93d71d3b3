# Compile settings that every vsplit target shares.
#
# vsplit_target(NAME) sets warnings, sanitizers and the floating-point contract on a target.
# -ffp-contract=off is part of the format, not a preference: encoder and decoder must round alike on
# every processor (proto/STREAM_FORMAT.md, "Arithmetic").
function(vsplit_target name)
    target_compile_options(
        ${name} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
                        -ffp-contract=off
    )
    if(VSPLIT_WERROR)
        target_compile_options(${name} PRIVATE -Werror)
    endif()
    if(VSPLIT_SANITIZE)
        target_compile_options(
            ${name} PRIVATE -fsanitize=${VSPLIT_SANITIZE} -fno-omit-frame-pointer -g
        )
        target_link_options(${name} PUBLIC -fsanitize=${VSPLIT_SANITIZE})
        if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
            # In instrumented code GCC raises false alarms, also inside system headers, and notes
            # every fence of Asio that the thread sanitizer does not see.
            target_compile_options(${name} PRIVATE -Wno-maybe-uninitialized -Wno-tsan)
        endif()
        if(VSPLIT_SANITIZE MATCHES "undefined")
            target_compile_options(${name} PRIVATE -fno-sanitize-recover=undefined)
        endif()
    endif()
    if(VSPLIT_BUILD_FUZZERS)
        # Without it libFuzzer sees no coverage inside the libraries and only guesses.
        target_compile_options(${name} PRIVATE -fsanitize=fuzzer-no-link)
    endif()
endfunction()
