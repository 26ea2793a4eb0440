/* check.h - shared by the test programs. C89. */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

/* Where CHECK prints. */
#ifndef CHECK_OUTPUT
#define CHECK_OUTPUT stderr
#endif

/* Ends the program with the source line and the library's reason if a condition does not hold. */
#define CHECK(Condition) \
    do { \
        if (!(Condition)) { \
            fprintf(CHECK_OUTPUT, "%s:%d: not so: %s (HandError: %s)\n", __FILE__, __LINE__, #Condition, HandError()); \
            exit(1); \
        } \
    } while (0)

/* The handle of the hand that OpenHand has opened. The calls of sun2xp.h take it. */
#define HAND sun2xp_default_hand()

#define PAUSE_MS(Milliseconds) \
    do { \
        struct timespec span; \
        span.tv_sec = (Milliseconds) / 1000; \
        span.tv_nsec = (Milliseconds) % 1000 * 1000000L; \
        nanosleep(&span, NULL); \
    } while (0)

#define APART(A, B) ((A) > (B) ? (A) - (B) : (B) - (A))
