# Options for building SDL. `.cargo/config.toml` names this file as CMake's toolchain file, since the sdl3-sys crate does not
# pass on these options. Without it SDL builds too, but in 115 s (debug) or 300 s (release) of processor time instead of 70 s.

# The shared library and the test library are not used.
set(SDL_SHARED OFF CACHE BOOL "")
set(SDL_TEST_LIBRARY OFF CACHE BOOL "")

# Failed assertions would ask on the terminal and block the thread.
set(SDL_ASSERTIONS "release" CACHE STRING "")

# Not needed for sticks, and only present on some machines.
set(SDL_DBUS OFF CACHE BOOL "")
set(SDL_IBUS OFF CACHE BOOL "")
set(SDL_LIBURING OFF CACHE BOOL "")
set(SDL_PIPEWIRE OFF CACHE BOOL "")

# Reading sticks needs neither optimisation nor debug information in SDL.
foreach(build DEBUG RELEASE RELWITHDEBINFO MINSIZEREL)
    set(CMAKE_C_FLAGS_${build} "" CACHE STRING "")
endforeach()

# With a toolchain file the cmake crate does not set the target system, and SDL would be built for the host.
if("$ENV{TARGET}" STREQUAL "x86_64-pc-windows-gnu" AND NOT CMAKE_HOST_WIN32)
    set(CMAKE_SYSTEM_NAME Windows)
    set(CMAKE_SYSTEM_PROCESSOR x86_64)
    set(CMAKE_C_COMPILER x86_64-w64-mingw32-gcc)
    set(CMAKE_CXX_COMPILER x86_64-w64-mingw32-g++)
    set(CMAKE_RC_COMPILER x86_64-w64-mingw32-windres)
endif()
