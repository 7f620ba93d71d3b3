# Cross compilation for a Debian architecture. Toolchain files set vsplit_triplet, vsplit_processor,
# vsplit_root (where libraries are, in build/) and vsplit_emulator, then include this.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR ${vsplit_processor})
set(CMAKE_CXX_COMPILER ${vsplit_triplet}-g++)
set(CMAKE_LIBRARY_ARCHITECTURE ${vsplit_triplet})

set(vsplit_sysroot ${CMAKE_CURRENT_LIST_DIR}/../build/${vsplit_root})
set(CMAKE_FIND_ROOT_PATH ${vsplit_sysroot})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(CMAKE_CXX_FLAGS_INIT "-isystem ${vsplit_sysroot}/usr/include")

set(CMAKE_CROSSCOMPILING_EMULATOR ${vsplit_emulator} -L /usr/${vsplit_triplet})
