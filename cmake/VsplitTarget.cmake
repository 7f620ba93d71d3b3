# Compile settings that every vsplit target shares.
#
# vsplit_target(NAME [TEST]) sets warnings, sanitizers and the floating-point contract on a target.
# TEST: its own sources only try out what they link.
# -ffp-contract=off is part of the format, not a preference: encoder and decoder must round alike on
# every processor (proto/STREAM_FORMAT.md, "Arithmetic").
function(vsplit_target name)
    cmake_parse_arguments(ARG "TEST" "" "" ${ARGN})
    target_compile_options(
        ${name} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
                        -ffp-contract=off
    )
    if(VSPLIT_WERROR)
        target_compile_options(${name} PRIVATE -Werror)
    endif()
    if(VSPLIT_SANITIZE)
        # How much debug information there is, the presets say: reports want lines, more costs the
        # compiler a quarter of its time.
        target_compile_options(
            ${name} PRIVATE -fsanitize=${VSPLIT_SANITIZE} -fno-omit-frame-pointer
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
        if(VSPLIT_SANITIZE MATCHES "address|thread")
            # It takes terabytes of address space; limits on that are for programs without.
            target_compile_definitions(${name} PRIVATE VSPLIT_SHADOW_MEMORY)
        endif()
    endif()
    if(VSPLIT_BUILD_FUZZERS AND ARG_TEST)
        # No fuzz target links them, and compiling them takes longer than running them.
        target_compile_options(${name} PRIVATE -O0)
    elseif(VSPLIT_BUILD_FUZZERS)
        # Without it libFuzzer sees no coverage inside the libraries and only guesses.
        target_compile_options(${name} PRIVATE -fsanitize=fuzzer-no-link)
    endif()
endfunction()
