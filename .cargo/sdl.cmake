# SDL is linked statically. By default it compiles every file once more for a shared library, and a library for its tests.
set(SDL_SHARED OFF CACHE BOOL "")
set(SDL_TEST_LIBRARY OFF CACHE BOOL "")
