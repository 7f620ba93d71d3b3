vsplit_fuzzer(stream_decoder_fuzzer stream_decoder_fuzzer.cpp vsplit_encode)
target_sources(stream_decoder_fuzzer PRIVATE ${PROJECT_SOURCE_DIR}/tests/codec/stream_parts.cpp)
target_include_directories(stream_decoder_fuzzer PRIVATE ${PROJECT_SOURCE_DIR}/tests)
