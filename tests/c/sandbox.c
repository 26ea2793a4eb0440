/* A sandbox (seccomp) refuses the planner one or two system calls that the library needs. OpenHand is refused with the
   errno of the sandbox, and its text names the sandbox as the cause. Each case runs in a process of its own. Exits with
   77 where the system permits no sandbox. */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <stddef.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>
#include "Sun2Xp.h"
#include "check.h"
#include "refused.h"

#define NOT_PERMITTED 77
/* Some processors have only epoll_pwait, and not the older epoll_wait. */
#ifndef SYS_epoll_wait
#define SYS_epoll_wait SYS_epoll_pwait
#endif
/* On machines without clone3 in their headers the C library does not use it either. */
#ifndef SYS_clone3
#define SYS_clone3 SYS_clone
#endif

struct refusal {
    /* A part of the refusal, which names what OpenHand cannot do. */
    const char *cannot;
    /* The refused system calls. */
    long calls[2];
    /* 1: the configuration names a port for each finger. 0: the fingers are simulated. */
    int real_port;
};

static const struct refusal refusals[] = {
    {"clock_nanosleep", {SYS_clock_nanosleep, SYS_clock_nanosleep}, 0},
    {"reading or writing the port", {SYS_ppoll, SYS_ppoll}, 0},
    {"reading or writing the port", {SYS_epoll_wait, SYS_epoll_pwait}, 0},
    {"cannot open /dev/pts/", {SYS_epoll_create1, SYS_epoll_ctl}, 0},
    {"thread", {SYS_clone, SYS_clone3}, 0},
    {"thread", {SYS_mprotect, SYS_mprotect}, 0},
    {"thread", {SYS_mmap, SYS_mmap}, 0},
    {"pseudo-terminal", {SYS_ioctl, SYS_ioctl}, 0},
    {"pseudo-terminal", {SYS_fcntl, SYS_fcntl}, 0},
    {"pseudo-terminal", {SYS_openat, SYS_openat}, 0},
    {"cannot open /dev/pts/", {SYS_flock, SYS_flock}, 0},
    {"cannot open /dev/pts/", {SYS_ioctl, SYS_ioctl}, 1},
    {"cannot open /dev/pts/", {SYS_fcntl, SYS_fcntl}, 1},
};

/* From now on, this thread and the threads that it starts cannot make these system calls. */
static void refuse(const long calls[2], int error)
{
    struct sock_filter code[] = {
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, nr)),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, (unsigned)calls[0], 1, 0),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, (unsigned)calls[1], 0, 1),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | (unsigned)error),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
    };
    struct sock_fprog program;

    program.len = sizeof code / sizeof code[0];
    program.filter = code;
    if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 || prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) != 0)
        _exit(NOT_PERMITTED);
}

/* Gives every finger a pseudo-terminal as its port. No board is connected to it. */
static void name_ports(void)
{
    FILE *file = fopen("sun2xp.toml", "w");
    int finger, board_end;

    CHECK(file != NULL);
    for (finger = 1; finger <= 3; finger++) {
        board_end = posix_openpt(O_RDWR | O_NOCTTY);
        CHECK(board_end >= 0 && grantpt(board_end) == 0 && unlockpt(board_end) == 0);
        CHECK(fprintf(file, "[finger.%d]\nport = \"%s\"\n", finger, ptsname(board_end)) > 0);
    }
    CHECK(fclose(file) == 0);
}

static void open_in_a_sandbox(const struct refusal *refusal, int error)
{
    alarm(60);
    if (refusal->real_port)
        name_ports();
    refuse(refusal->calls, error);
    REFUSED(OpenHand(), error, "sandbox (seccomp");
    CHECK(strstr(HandError(), refusal->cannot) != NULL);
    CHECK(strstr(HandError(), "permit it") != NULL);
    CHECK(strstr(HandError(), "Unplug") == NULL && strstr(HandError(), "defect") == NULL);
    CHECK(CloseHand() == 0);
    _exit(0);
}

int main(void)
{
    static const int errors[] = {EPERM, ENOSYS};
    size_t number;

    for (number = 0; number < 2 * sizeof refusals / sizeof refusals[0]; number++) {
        const struct refusal *refusal = &refusals[number / 2];
        int error = errors[number % 2], status;
        pid_t child = fork();

        CHECK(child >= 0);
        if (child == 0)
            open_in_a_sandbox(refusal, error);
        CHECK(waitpid(child, &status, 0) == child);
        if (WIFEXITED(status) && WEXITSTATUS(status) == NOT_PERMITTED)
            return NOT_PERMITTED;
        if (status != 0)
            fprintf(stderr, "system call %ld, %s\n", refusal->calls[0], strerror(error));
        CHECK(status == 0);
    }
    return 0;
}
