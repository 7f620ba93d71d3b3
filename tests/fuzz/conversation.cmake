# The fuzz preset does not build the server; this much of it needs no sockets and no files.
vsplit_fuzzer(conversation_fuzzer conversation_fuzzer.cpp vsplit_wire vsplit_stream_info)
target_sources(conversation_fuzzer PRIVATE ${PROJECT_SOURCE_DIR}/server/net/conversation.cpp)
target_include_directories(conversation_fuzzer PRIVATE ${PROJECT_SOURCE_DIR}/server)
