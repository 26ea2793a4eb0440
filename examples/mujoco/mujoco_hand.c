/* mujoco_hand.c - a hand whose fingers are simulated in another process, in step with the servo (C11).

       mujoco_hand MEMORY      uses the fingers of simulation.py. Both programs map the file MEMORY
       mujoco_hand             uses the built-in simulated fingers

   The program moves the fingers to some poses, waits until they have settled, and prints where they rest. */

#ifndef _DEFAULT_SOURCE
#define _DEFAULT_SOURCE
#endif

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>
#include "sun2xp.h"

/* One servo thread serves all fingers, one after the other. */
#define CONFIGURATION \
    "[hand]\nreal_time = \"ignore\"\nend_state = \"release\"\n[finger]\nport = \"simulated\"\nthread = 1\n"

/* Longest wait for the simulation in one exchange, s. After this time the exchange fails. The library repeats it after
   about 100 ms. */
#define PATIENCE 0.08

/* The memory that both programs share: numbers of 8 bytes. simulation.py has the same layout. */
struct finger_memory {
    double torques[4], tensions[4], encoders[4], joints[3];
};

struct memory {
    _Atomic unsigned long long ready, requested, done, ended;
    double time;
    struct finger_memory fingers[3];
};

/* The step of the present cycle, for all fingers. Only the servo thread uses it. */
struct step {
    double deadline;                    /* of the commands of the cycle */
    int owed;                           /* 1 until the simulation has made the last requested step */
    int result;
};

struct finger {
    struct memory *memory;
    struct step *step;
    int number;                         /* 0 to 2 */
};

static void nap(void)
{
    struct timespec time = {0, 20000};

    nanosleep(&time, NULL);
}

static double seconds(void)
{
    struct timespec time;

    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static void read_sample(const struct finger *finger, struct sun2xp_io_sample *sample)
{
    const struct finger_memory *memory = &finger->memory->fingers[finger->number];
    int i;

    for (i = 0; i < 4; i++) {
        sample->tensions[i] = memory->tensions[i];
        sample->encoders[i] = (int)memory->encoders[i];
    }
    sample->time = 1 + finger->memory->time;
}

static int start(void *user, const struct sun2xp_io_terms *terms, struct sun2xp_io_sample *first)
{
    struct finger *finger = user;

    (void)terms;
    read_sample(finger, first);
    return 0;
}

/* Advances the simulation by one period. If the simulation does not complete this step within PATIENCE, the next call
   waits for the same step, and requests no other. */
static int advance(struct step *step, struct memory *memory)
{
    double deadline = seconds() + PATIENCE;

    if (!step->owed)
        atomic_fetch_add(&memory->requested, 1);
    step->owed = 1;
    while (atomic_load(&memory->done) != atomic_load(&memory->requested)) {
        if (seconds() > deadline)
            return ETIMEDOUT;
        nap();
    }
    step->owed = 0;
    return 0;
}

/* The first exchange of a cycle advances the simulation by one period, with the torques of the previous cycle. All
   fingers are sampled at the end of this period. The torques of the present cycle act in the next period. A new
   deadline marks the first exchange of a cycle. The first exchange need not be that of finger 1, because a faulted
   finger gets no exchange. */
static int exchange(void *user, const struct sun2xp_io_command *command, struct sun2xp_io_sample *sample)
{
    struct finger *finger = user;
    struct step *step = finger->step;

    if (command->deadline != step->deadline) {
        step->deadline = command->deadline;
        step->result = advance(step, finger->memory);
    }
    if (step->result == 0) {
        read_sample(finger, sample);
        memcpy(finger->memory->fingers[finger->number].torques, command->torques, sizeof command->torques);
    }
    return step->result;
}

static int stop(void *user)
{
    struct finger *finger = user;

    memset(finger->memory->fingers[finger->number].torques, 0, sizeof finger->memory->fingers[0].torques);
    return 0;
}

static struct memory *map(const char *path)
{
    struct memory *memory;
    double deadline = seconds() + 60;
    int file;

    /* The simulation makes the file, so it may not exist yet. */
    while ((file = open(path, O_RDWR)) < 0 || lseek(file, 0, SEEK_END) < (off_t)sizeof *memory) {
        if (file >= 0)
            close(file);
        else if (errno != ENOENT)
            return NULL;
        if (seconds() > deadline) {
            errno = ETIMEDOUT;
            return NULL;
        }
        nap();
    }
    memory = mmap(NULL, sizeof *memory, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    close(file);
    if (memory == MAP_FAILED)
        return NULL;
    while (atomic_load(&memory->ready) == 0) {
        if (seconds() > deadline) {
            munmap(memory, sizeof *memory);
            errno = ETIMEDOUT;
            return NULL;
        }
        nap();
    }
    return memory;
}

static int move(sun2xp_hand *hand, const struct memory *memory)
{
    static const double Poses[3][3] = {{0.2, 0.6, 1.1}, {-0.3, 1.0, 1.5}, {0.1, 0.5, 0.8}};
    double position[3];
    int pose, finger;

    for (pose = 0; pose < 3; pose++) {
        for (finger = 1; finger <= 3; finger++)
            if (sun2xp_send_position(hand, finger, Poses[(pose + finger) % 3]) != 0)
                return -1;
        if (sun2xp_wait(hand, SUN2XP_ALL_FINGERS, SUN2XP_WAIT_SETTLED, 30.0) != 0)
            return -1;
        for (finger = 1; finger <= 3; finger++) {
            if (sun2xp_position(hand, finger, position) != 0)
                return -1;
            printf("%d %d %.6f %.6f %.6f", pose, finger, position[0], position[1], position[2]);
            if (memory != NULL)
                printf(" %.6f %.6f %.6f", memory->fingers[finger - 1].joints[0], memory->fingers[finger - 1].joints[1],
                    memory->fingers[finger - 1].joints[2]);
            printf("\n");
        }
    }
    return 0;
}

int main(int count, char **arguments)
{
    struct memory *memory = count > 1 ? map(arguments[1]) : NULL;
    struct step step = {0, 0, 0};
    struct finger fingers[3];
    struct sun2xp_io io[3];
    sun2xp_hand *hand;
    int i, result;

    if (count > 1 && memory == NULL) {
        const char *remedy = errno == ETIMEDOUT ? ": start simulation.py with the same file" : "";

        fprintf(stderr, "%s: %s%s\n", arguments[1], strerror(errno), remedy);
        return 1;
    }
    memset(io, 0, sizeof io);
    for (i = 0; i < 3; i++) {
        fingers[i].memory = memory;
        fingers[i].step = &step;
        fingers[i].number = i;
        io[i].size = sizeof io[i];
        io[i].finger = i + 1;
        io[i].in_step = 1;
        io[i].user = &fingers[i];
        io[i].start = start;
        io[i].exchange = exchange;
        io[i].stop = stop;
    }
    result = sun2xp_open_io_text(CONFIGURATION, memory != NULL ? 3 : 0, io, &hand);
    if (result == 0) {
        result = move(hand, memory);
        if (result != 0)
            fprintf(stderr, "%s\n", sun2xp_error_text(NULL));
        sun2xp_close(hand);
    } else {
        fprintf(stderr, "%s\n", sun2xp_error_text(NULL));
    }
    if (memory != NULL)
        atomic_store(&memory->ended, 1);
    return result == 0 ? 0 : 1;
}
