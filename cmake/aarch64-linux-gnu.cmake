# Cross compilation for AArch64; libraries come from build/arm64-root (scripts/build-arm64).
set(vsplit_triplet aarch64-linux-gnu)
set(vsplit_processor aarch64)
set(vsplit_root arm64-root)
set(vsplit_emulator qemu-aarch64-static)
include(${CMAKE_CURRENT_LIST_DIR}/CrossCompile.cmake)
