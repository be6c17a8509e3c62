# How SDL is built: what `.cargo/config.toml` names as CMake's toolchain file, since the sdl3-sys crate passes on no option of
# these. Without it SDL is built just as well, but in 115 s of processor time in debug and 300 s in release instead of 70 s.

# Nobody links the shared library or the test library.
set(SDL_SHARED OFF CACHE BOOL "")
set(SDL_TEST_LIBRARY OFF CACHE BOOL "")

# Failed assertions would ask at the terminal what to do, and the thread would wait for the answer.
set(SDL_ASSERTIONS "release" CACHE STRING "")

# Not for sticks, and only found on some machines.
set(SDL_DBUS OFF CACHE BOOL "")
set(SDL_IBUS OFF CACHE BOOL "")
set(SDL_LIBURING OFF CACHE BOOL "")
set(SDL_PIPEWIRE OFF CACHE BOOL "")

# Reading sticks needs no optimising compiler, nor the debug information of SDL.
foreach(build DEBUG RELEASE RELWITHDEBINFO MINSIZEREL)
    set(CMAKE_C_FLAGS_${build} "" CACHE STRING "")
endforeach()

# A toolchain file keeps the cmake crate from saying which system is meant, and SDL would be built for this one.
if("$ENV{TARGET}" STREQUAL "x86_64-pc-windows-gnu" AND NOT CMAKE_HOST_WIN32)
    set(CMAKE_SYSTEM_NAME Windows)
    set(CMAKE_SYSTEM_PROCESSOR x86_64)
    set(CMAKE_C_COMPILER x86_64-w64-mingw32-gcc)
    set(CMAKE_CXX_COMPILER x86_64-w64-mingw32-g++)
    set(CMAKE_RC_COMPILER x86_64-w64-mingw32-windres)
endif()
