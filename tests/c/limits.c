/* The system refuses descriptors, threads, pseudo-terminals and a port, one after the other. OpenHand reports the
   system's errno and the remedy, leaves nothing behind, and succeeds once the limit is gone. This program replaces
   functions of the system by its own, which refuse the threads, the pseudo-terminals and the port. */
#define _GNU_SOURCE
#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdarg.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>
#include "Sun2Xp.h"
#include "sun2xp.h"
#include "check.h"
#include "refused.h"

/* A port that is not ready: opening it fails with EAGAIN. */
#define PORT "/dev/sun2xp-not-ready"

/* Which thread and which pseudo-terminal is refused, counted from 1 (0 refuses none), and how many were requested. */
static int refused_thread, refused_terminal, threads, terminals;
/* The errno of the refused pseudo-terminal. */
static int terminal_error;

typedef int thread_maker(pthread_t *, const pthread_attr_t *, void *(*)(void *), void *);
typedef int terminal_maker(int);
typedef int file_opener(const char *, int, ...);

int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*start)(void *), void *argument)
{
    thread_maker *next;

    *(void **)&next = dlsym(RTLD_NEXT, "pthread_create");
    return ++threads == refused_thread ? EAGAIN : next(thread, attributes, start, argument);
}

int posix_openpt(int flags)
{
    terminal_maker *next;

    *(void **)&next = dlsym(RTLD_NEXT, "posix_openpt");
    if (++terminals != refused_terminal)
        return next(flags);
    errno = terminal_error;
    return -1;
}

int open(const char *path, int flags, ...)
{
    file_opener *next;
    mode_t mode = 0;
    va_list rest;

    if (strcmp(path, PORT) == 0) {
        errno = EAGAIN;
        return -1;
    }
    if (flags & O_CREAT) {
        va_start(rest, flags);
        mode = va_arg(rest, mode_t);
        va_end(rest);
    }
    *(void **)&next = dlsym(RTLD_NEXT, "open");
    return next(path, flags, mode);
}

/* The number of entries in a folder. */
static int entries(const char *folder)
{
    DIR *open = opendir(folder);
    int number = 0;

    CHECK(open != NULL);
    while (readdir(open) != NULL)
        number++;
    closedir(open);
    return number;
}

static void open_and_close(void)
{
    CHECK(OpenHand() == 0);
    CHECK(CloseHand() == 0);
}

static int descriptors, tasks;

static void check_that_nothing_is_left(void)
{
    CHECK(entries("/proc/self/fd") == descriptors && entries("/proc/self/task") == tasks);
}

static void refuse_descriptors(void)
{
    struct rlimit limit, before;
    int result, number, refused = 0;

    CHECK(getrlimit(RLIMIT_NOFILE, &before) == 0);
    limit = before;
    /* The limit of descriptors rises by one each time. */
    for (limit.rlim_cur = 3;; limit.rlim_cur++) {
        CHECK(setrlimit(RLIMIT_NOFILE, &limit) == 0);
        result = OpenHand();
        number = errno;
        CHECK(setrlimit(RLIMIT_NOFILE, &before) == 0);
        if (result == 0)
            break;
        CHECK(number == EMFILE && strstr(HandError(), "ulimit -n") != NULL);
        check_that_nothing_is_left();
        refused++;
    }
    CHECK(CloseHand() == 0);
    printf("%d openings were refused for lack of descriptors\n", refused);
    CHECK(refused >= 9);
}

static void refuse_terminals(void)
{
    static const int errors[] = {ENOENT, ENODEV, EACCES, EINVAL};
    int number;

    for (refused_terminal = 1; refused_terminal <= 3; refused_terminal++) {
        terminals = 0;
        terminal_error = ENOSPC;
        REFUSED(OpenHand(), ENOSPC, "kernel.pty.max");
        check_that_nothing_is_left();
    }
    /* The four errors mean: /dev/ptmx is missing, /dev/pts is not mounted, opening /dev/ptmx is not permitted, and
       /dev/ptmx is another device. */
    for (number = 0; number < 4; number++) {
        refused_terminal = 1;
        terminals = 0;
        terminal_error = errors[number];
        REFUSED(OpenHand(), errors[number], "mount -t devpts");
        check_that_nothing_is_left();
    }
    refused_terminal = 0;
}

/* EAGAIN at a port has nothing to do with the limit of threads. */
static void refuse_a_port(void)
{
    sun2xp_hand *hand = NULL;

    REFUSED(sun2xp_open_text("[hand]\nfingers = [1]\n[finger.1]\nport = \"" PORT "\"\n", &hand), EAGAIN,
            PORT " is not ready");
    CHECK(strstr(HandError(), "ulimit") == NULL && strstr(HandError(), "thread") == NULL);
    CHECK(hand == NULL);
    check_that_nothing_is_left();
}

static void refuse_threads(void)
{
    int number;

    threads = 0;
    CHECK(OpenHand() == 0);
    number = threads;
    CHECK(CloseHand() == 0);
    CHECK(number >= 7);
    for (refused_thread = 1; refused_thread <= number; refused_thread++) {
        threads = 0;
        REFUSED(OpenHand(), EAGAIN, "ulimit -u");
        check_that_nothing_is_left();
    }
    refused_thread = 0;
    printf("each of %d threads was refused\n", number);
}

/* Other slow calls need a thread too. CloseHand closes the hand even if it cannot get one. */
static void refuse_the_thread_of_a_call(void)
{
    CHECK(OpenHand() == 0);
    threads = 0;
    refused_thread = 1;
    REFUSED(sun2xp_zero(HAND, 1), EAGAIN, "ulimit -u");
    threads = 0;
    CHECK(CloseHand() == 0);
    CHECK(threads == 1);
    refused_thread = 0;
}

int main(void)
{
    int number;

    alarm(100);
    for (number = 3; number < 1024; number++)
        close(number);
    open_and_close();
    descriptors = entries("/proc/self/fd");
    tasks = entries("/proc/self/task");
    refuse_descriptors();
    refuse_terminals();
    refuse_a_port();
    refuse_threads();
    refuse_the_thread_of_a_call();
    open_and_close();
    return 0;
}
