/* refused.h - for programs that test many refusals by errno and a word of the text. C89. */
#include <errno.h>
#include <string.h>

#define REFUSED(Call, Errno, Word) \
    do { \
        errno = 0; \
        CHECK((Call) < 0); \
        CHECK(errno == (Errno)); \
        CHECK(strstr(HandError(), (Word)) != NULL); \
    } while (0)
