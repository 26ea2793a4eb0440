/* How order.c reports a refusal. */

static const char *name_of(int number)
{
    switch (number) {
    case EBUSY: return "EBUSY";
    case EDOM: return "EDOM";
    case EFAULT: return "EFAULT";
    case EINVAL: return "EINVAL";
    case EIO: return "EIO";
    case ENODEV: return "ENODEV";
    case ENOENT: return "ENOENT";
    case ENOSPC: return "ENOSPC";
    case ENOTSUP: return "ENOTSUP";
    case ERANGE: return "ERANGE";
    default: return strerror(number);
    }
}

/* Checks that the call is refused, and that the error text contains this word. Prints the call and the errno. */
#define REFUSED(Call, Result, Word) \
    do { \
        CHECK((Result) < 0); \
        printf("%s %s\n", (Call), name_of(errno)); \
        CHECK(strstr(HandError(), (Word)) != NULL); \
    } while (0)
