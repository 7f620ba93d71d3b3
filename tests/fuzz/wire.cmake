vsplit_fuzzer(wire_fuzzer wire_fuzzer.cpp vsplit_wire)
