vsplit_fuzzer(attribute_fuzzer attribute_fuzzer.cpp vsplit_encode)
target_sources(
    attribute_fuzzer PRIVATE ${PROJECT_SOURCE_DIR}/tests/codec/stream_parts.cpp
)
target_include_directories(attribute_fuzzer PRIVATE ${PROJECT_SOURCE_DIR}/tests)
target_compile_definitions(
    attribute_fuzzer PRIVATE VSPLIT_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
)
