#pragma once

#include <cstdio>
#include <cstdlib>

/// Stops the program when a caller broke a precondition. Never used on values that came from a file
/// or a peer: those are answered with an Error. Active unless NDEBUG is defined.
#ifdef NDEBUG
#define VSPLIT_ASSERT(condition) static_cast<void>(0)
#else
#define VSPLIT_ASSERT(condition)                                                           \
    do                                                                                     \
    {                                                                                      \
        if (!(condition))                                                                  \
        {                                                                                  \
            std::fprintf(                                                                  \
                stderr, "%s:%d: precondition failed: %s\n", __FILE__, __LINE__, #condition \
            );                                                                             \
            std::abort();                                                                  \
        }                                                                                  \
    }                                                                                      \
    while (false)
#endif
