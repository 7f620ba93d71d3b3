# Cross compilation for WebAssembly with the system interface WASI; sources and headers that are not
# packaged for it come from build/wasm-root (scripts/build-wasm).
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR wasm32)
set(CMAKE_CXX_COMPILER clang++-16)
set(CMAKE_CXX_COMPILER_TARGET wasm32-wasi)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(draco_DIR ${CMAKE_CURRENT_LIST_DIR}/wasm32)

# Its C++ library has no exceptions: what throws ends the program.
set(vsplit_wasm_root ${CMAKE_CURRENT_LIST_DIR}/../build/wasm-root)
set(CMAKE_CXX_FLAGS_INIT "-fignore-exceptions -U__EXCEPTIONS -D_LIBCPP_NO_EXCEPTIONS -nostdinc++ \
-isystem /usr/lib/llvm-16/include/wasm32-wasi/c++/v1 -isystem ${vsplit_wasm_root}/include")
set(CMAKE_EXE_LINKER_FLAGS_INIT "-Wl,-z,stack-size=1048576")
