/* A planner reads the status of finger 1 while the servo thread of this finger is stopped, as a debugger stops threads,
   and again after the thread has been released. */
#include <dirent.h>
#include <errno.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/ptrace.h>
#include <sys/wait.h>
#include <unistd.h>
#include "Sun2Xp.h"
#include "sun2xp.h"
#include "check.h"

/* The thread number of the servo of finger 1. */
static int servo(void)
{
    DIR *threads = opendir("/proc/self/task");
    struct dirent *thread;
    int number = 0;

    CHECK(threads != NULL);
    while (number == 0 && (thread = readdir(threads)) != NULL) {
        char path[300], name[32] = "";
        FILE *file;
        sprintf(path, "/proc/self/task/%s/comm", thread->d_name);
        file = fopen(path, "r");
        if (file == NULL)
            continue;
        if (fgets(name, sizeof name, file) != NULL && strcmp(name, "sun2xp servo 1\n") == 0)
            number = atoi(thread->d_name);
        fclose(file);
    }
    closedir(threads);
    return number;
}

/* Runs in a child: stops the thread, notifies the parent, and releases the thread when the parent asks for it. */
static void hold(int thread, int held, int go)
{
    char byte = 0;
    int status;

    if (ptrace(PTRACE_SEIZE, thread, NULL, NULL) != 0 || ptrace(PTRACE_INTERRUPT, thread, NULL, NULL) != 0)
        _exit(errno);
    if (waitpid(thread, &status, __WALL) != thread || write(held, &byte, 1) != 1 || read(go, &byte, 1) != 1)
        _exit(1);
    _exit(ptrace(PTRACE_DETACH, thread, NULL, NULL) == 0 ? 0 : 2);
}

static struct sun2xp_status look(void)
{
    struct sun2xp_status Status;

    Status.size = sizeof Status;
    CHECK(sun2xp_status(HAND, 1, &Status) == 0);
    return Status;
}

int main(void)
{
    struct sun2xp_status Before, Held, Later;
    int thread, status, to_child[2], to_parent[2];
    pid_t child;
    char byte;

    CHECK(OpenHand() == 0);
    PAUSE_MS(200);
    thread = servo();
    CHECK(thread > 0 && pipe(to_child) == 0 && pipe(to_parent) == 0);
    /* Lets the child trace this process on systems where a process can trace only its descendants. The call fails on
       other systems. */
    prctl(PR_SET_PTRACER, -1L, 0, 0, 0);
    child = fork();
    CHECK(child >= 0);
    if (child == 0) {
        /* If the parent ends early, the child reads the end of the pipe and releases the thread. */
        close(to_child[1]);
        hold(thread, to_parent[1], to_child[0]);
    }
    close(to_parent[1]);
    CHECK(read(to_parent[0], &byte, 1) == 1);
    Before = look();
    PAUSE_MS(500);
    Held = look();
    CHECK(Held.cycles == Before.cycles);
    CHECK(Held.skipped_periods >= Before.skipped_periods + 490);
    CHECK(Held.measured_rate < 0.8 * Before.measured_rate);
    PAUSE_MS(500);
    CHECK(look().skipped_periods >= Held.skipped_periods + 490);
    Held = look();
    CHECK(write(to_child[1], &byte, 1) == 1);
    CHECK(waitpid(child, &status, 0) == child && status == 0);
    PAUSE_MS(100);
    Later = look();
    /*
     * The periods that were skipped must be counted only once. A period that was counted as skipped while the thread
     * was held can count as a cycle afterwards, if its cycle had almost ended when the thread was held.
     */
    CHECK(Later.cycles > Held.cycles);
    CHECK(Later.skipped_periods + Later.cycles >= Held.skipped_periods + Held.cycles);
    CHECK(Later.skipped_periods + Later.cycles < Held.skipped_periods + Held.cycles + 2000);
    return CloseHand();
}
