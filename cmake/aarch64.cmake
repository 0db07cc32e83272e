# Debian's cross compiler for 64-bit ARM; libraries come from its packages for arm64, programs run
# under qemu. Linked statically: threads of programs linked to glibc's shared library hang in QEMU 7.2
# on some kernels.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64 -L /usr/aarch64-linux-gnu)
set(CMAKE_EXE_LINKER_FLAGS_INIT -static)
set(PNG_LIBRARY_RELEASE /usr/lib/aarch64-linux-gnu/libpng.a CACHE FILEPATH "")
set(ZLIB_LIBRARY_RELEASE /usr/lib/aarch64-linux-gnu/libz.a CACHE FILEPATH "")
