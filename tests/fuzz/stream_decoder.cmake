foreach(name stream_decoder_fuzzer batch_decoder_fuzzer growth_fuzzer parts_fuzzer)
    vsplit_fuzzer(${name} ${name}.cpp vsplit_encode)
    target_sources(
        ${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests/codec/shapes.cpp
                        ${PROJECT_SOURCE_DIR}/tests/codec/stream_parts.cpp
    )
    target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
endforeach()
