// check.hpp - the macro CHECK for the test programs in C++.
#ifndef CHECK_HPP
#define CHECK_HPP
#include <cstdio>
#include <cstdlib>

/* If a condition does not hold, prints it with its file and line, and ends the program. */
#define CHECK(Condition) \
    do { \
        if (!(Condition)) { \
            std::fprintf(stderr, "%s:%d: not so: %s\n", __FILE__, __LINE__, #Condition); \
            std::exit(1); \
        } \
    } while (0)

#endif
