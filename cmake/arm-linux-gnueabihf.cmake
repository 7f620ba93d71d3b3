# Cross compilation for ARMv7 with hardware floating point; libraries come from build/armv7-root
# (scripts/build-armv7).
set(vsplit_triplet arm-linux-gnueabihf)
set(vsplit_processor armv7l)
set(vsplit_root armv7-root)
set(vsplit_emulator qemu-arm-static)
include(${CMAKE_CURRENT_LIST_DIR}/CrossCompile.cmake)
