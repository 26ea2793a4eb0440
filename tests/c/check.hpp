// check.hpp - the check of the programs in C++.
#ifndef CHECK_HPP
#define CHECK_HPP
#include <cstdio>
#include <cstdlib>

/* Ends the program with the source line if a condition does not hold. */
#define CHECK(Condition) \
    do { \
        if (!(Condition)) { \
            std::fprintf(stderr, "%s:%d: not so: %s\n", __FILE__, __LINE__, #Condition); \
            std::exit(1); \
        } \
    } while (0)

#endif
