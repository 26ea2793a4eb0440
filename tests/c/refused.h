/* refused.h - for programs that try many refusals: each with its errno and a word of its text. C89. */
#include <errno.h>
#include <string.h>

#define REFUSED(Call, Errno, Word) \
    do { \
        errno = 0; \
        CHECK((Call) == -1); \
        CHECK(errno == (Errno)); \
        CHECK(strstr(HandError(), (Word)) != NULL); \
    } while (0)
