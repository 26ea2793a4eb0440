/* sun2xp.h - hands as sets of springs: the C interface for new programs

   GENERATED from src/capi/; do not edit. To renew it:

       SUN2XP_WRITE_HEADER=1 cargo test --test header

       1. Quick start             4. Structs
       2. Results and errors      5. Threads, signals, fork, exit
       3. Units, frames, order    6. Servo and real time

   After these chapters, the calls follow in sections. The comment above a call is the entry of this call.
   Sun2Xp.h has the five calls of 1990, such as OpenHand. The calls of this header also work on the hand
   that OpenHand has opened: sun2xp_default_hand returns its handle. The report is COINS Technical Report
   90-48 (1990), which describes the controller. A planner is a program that commands a hand. A board is
   I/O hardware at a serial port: it drives the motors of one or more fingers and reads their sensors.
   Names that begin with "hand." or "finger." are keys of the configuration file (docs/sun2xp.toml).


   1. QUICK START

   Example, planner.c:

       #include <stdio.h>
       #include <sun2xp.h>

       int main(void)
       {
           double stiffness[9] = {3, 0, 0, 0, 3, 0, 0, 0, 3};
           double position[3] = {0.0, 0.5, 0.8};
           sun2xp_hand *hand;

           if (sun2xp_open(NULL, &hand) != 0) {
               fprintf(stderr, "%s\n", sun2xp_error_text(NULL));
               return 1;
           }
           sun2xp_send_stiffness(hand, 1, stiffness);
           sun2xp_send_position(hand, 1, position);
           sun2xp_wait(hand, 1, SUN2XP_WAIT_SETTLED, 5.0);
           if (sun2xp_position(hand, 1, position) == 0)
               printf("%.2f %.2f %.2f\n", position[0], position[1], position[2]);
           return sun2xp_close(hand) != 0;
       }

   Example, how to compile and run it after make install:

       cc planner.c $(pkg-config --cflags --libs sun2xp)
       ./a.out

   Each finger is a spring: it pulls its tip toward the position sent last, with the stiffness sent last.
   Without a configuration file the program moves a simulated hand.


   2. RESULTS AND ERRORS

   A call that succeeds and returns an int returns 0, or a number above 0 that its entry describes. A
   refused call returns the negative of a SUN2XP_ERROR_ number, sets errno, and changes nothing unless its
   entry says otherwise. sun2xp_error gives the number, the text and the remedy of the calling thread's
   last refusal, for one hand or for any hand. A call that succeeds changes neither errno nor this refusal.
   If there are several reasons to refuse a call, the call reports the one that its entry lists first. The
   most common errnos and their SUN2XP_ERROR_ numbers are:

       EPERM      SUN2XP_ERROR_FORKED          the process is a forked child (chapter 5)
       EFAULT     SUN2XP_ERROR_ARGUMENT        an argument is a null pointer
       ENODEV     SUN2XP_ERROR_NO_HAND         the handle is null, unknown to the library, or that of a closed hand
       EINVAL     SUN2XP_ERROR_ARGUMENT        no such finger; NaN or infinity; a wrong size
       EINVAL     SUN2XP_ERROR_NOT_SUPPORTED   a finger that the hand does not have (hand.fingers)
       EINVAL     SUN2XP_ERROR_CONFIGURATION   an unusable configuration
       ERANGE     SUN2XP_ERROR_LIMIT           outside the limits of the finger
       EDOM       SUN2XP_ERROR_LIMIT           a matrix that is not symmetric, or has a negative eigenvalue
       EIO        SUN2XP_ERROR_FAULTED         a fault, sun2xp_stop or sun2xp_stop_all has stopped the finger
       EBUSY      SUN2XP_ERROR_BUSY            hand or finger is being opened, closed, calibrated or recovered
       ETIMEDOUT  SUN2XP_ERROR_TIMED_OUT       a time limit has expired
       ENOTSUP    SUN2XP_ERROR_NOT_SUPPORTED   the call needs a simulated finger or object, or a hand on this machine
       ESHUTDOWN  SUN2XP_ERROR_EXITING         the process is exiting (chapter 5)
       others     the errno of the system, or the errno that describes the reason best

   Arrays, structs and texts of the program are read and written only during the call. A result is written
   only if the call succeeds. sun2xp_next_event and sun2xp_wait_event write their result only if they
   return 1.

   The first refusal of each kind in a process is also reported in a message, unless hand.print_refusals is
   false for the hand of the call. Refusals with the same cause are of one kind, whatever their arguments
   were. If a call opens a hand, or if its handle belongs to no open hand, the message appears even if this
   key is false. Messages go to the callback of sun2xp_set_log if there is one, and otherwise to standard
   error.


   3. UNITS, FRAMES, ORDER

   Angles are in rad, lengths in cm, forces in N, torques in N cm, stiffness in N/cm, times in s unless an
   entry says otherwise. Fingers are 1, 2 and 3; 3 is the thumb. SUN2XP_ALL_FINGERS (0) is accepted only
   where an entry says so. Joints are 0, 1 and 2: 0 turns the finger sideways, 1 and 2 bend it. Matrices
   are in row-major order: pass matrix[9], or &matrix[0][0] of matrix[3][3].

   The frame of a finger has its origin at the finger's base. With link lengths l0, l1, l2 and joint
   angles j0, j1, j2, the tip is at

       x = (l0 + l1 cos(j1) + l2 cos(j1 + j2)) sin(j0)
       y = -l1 sin(j1) - l2 sin(j1 + j2)
       z = (l0 + l1 cos(j1) + l2 cos(j1 + j2)) cos(j0)

   The palm's frame is common to all fingers: finger.base and finger.turn_degrees of the configuration give
   the position and the direction of each finger in this frame.


   4. STRUCTS

   The first member of every struct is size. Set it to the sizeof of the struct before the call. A size
   below that of the struct's first version is refused, and so is one above 4096. Later versions of the
   library add members at the end. If a program was compiled with a newer header and runs with an older
   library, this library ignores the argument members that it does not know, and sets such result members
   to zero. The library never changes the size that a program has set. In the structs that it passes to
   functions of the program, the library sets size itself.


   5. THREADS, SIGNALS, FORK, EXIT

   Threads: any thread may make any call, also while other threads make calls. A servo never waits for a
   call, and no call waits for the opening or closing of another hand. If two threads command one finger,
   the later call wins; each command takes effect as a whole.

   Signals: the servo threads block all signals. A signal handler may call sun2xp_stop_all, and no other
   call. C does not guarantee that exit works in a signal handler. If a handler calls exit nevertheless,
   the library closes the hands. If the signal interrupted a call that opens or closes a hand, the process
   may end before that hand is closed. Then the boards' watchdogs end the motion.

   The program's arrays, structs and texts may lie in pages that its own handler of SIGSEGV or SIGBUS makes
   accessible when a call first accesses them.

   Standard error: messages are lost if standard error is a pipe without a reader, or a file that may not
   grow. The program gets no SIGPIPE and no SIGXFSZ for messages. A call that prints a message waits until
   the message is written. A servo never waits for that.

   Stack: a call needs up to 16 KiB of its thread's stack, but sun2xp_send_path and sun2xp_send_group need
   up to 48 KiB. The stack of each thread of the library contains a copy of the program's thread-local data
   (__thread). Large thread-local data therefore enlarge the locked memory of each servo.

   Sandbox: install a sandbox (seccomp) before a hand is opened. If it forbids a system call that threads,
   waits, ports or pseudo-terminals need, opening is refused with the errno of the sandbox.

   Slow calls: a slow call runs in a thread of the library, and the program's thread waits for it. If no
   such thread can be started, a call that closes a hand runs in the program's thread instead. The slow
   calls are those that open or close a hand, sun2xp_recover, sun2xp_zero, sun2xp_identify, sun2xp_adjust,
   sun2xp_write_black_box, sun2xp_wait, sun2xp_on_event, sun2xp_event_descriptor and, while there is no
   event, sun2xp_wait_event. A signal handler may jump out of the wait for a slow call (siglongjmp). The
   call then continues to its end. If a handler jumps out of sun2xp_wait_event, that call takes no event.
   If it jumps out of a call that opens a hand, that call writes no handle, and the hand stays open until
   exit.

   Undefined behaviour: the behaviour is undefined if a signal handler jumps (longjmp, siglongjmp) out of a
   call that is not slow. The same holds if a handler interrupts any call and then calls pthread_exit or,
   in C++, lets an exception escape.

   Memory: opening allocates the memory for the servos, for closing and for all calls that are not slow,
   except sun2xp_send_path. So closing and these calls work even if malloc later returns NULL. Each call of
   the following table is refused with ENOMEM if less memory is free than the table says:

       12 MiB   the calls that open a hand
        4 MiB   sun2xp_recover, sun2xp_zero, sun2xp_identify, sun2xp_adjust, sun2xp_write_black_box
        1 MiB   sun2xp_send_path
       64 KiB   sun2xp_wait, sun2xp_on_event, sun2xp_event_descriptor, sun2xp_wait_event

   ENOMEM is the second reason that these calls check, after EPERM, even if an entry does not list it there.
   There are two exceptions. sun2xp_send_path checks it after EFAULT. sun2xp_wait_event checks it after all
   its other reasons, and only if there is no event. If memory runs out while one of these calls runs, the
   process is aborted, and the boards' watchdogs end the motion. If less than 4 MiB are free when a finger
   faults, no black box is written, and a message says so. If the library was loaded with dlopen, the first
   call of a thread needs memory for the thread-local data of the library. If this memory is not available,
   the C library aborts the process.

   Cancellation: pthread_cancel does not interrupt a call. It takes effect at the program's next
   cancellation point or, with asynchronous cancellation, when the call returns.

   Floating point: the library computes in the default environment. A call leaves the program's rounding
   mode, traps, treatment of denormals and exception flags as they were.

   Fork: a child process has no servo threads. Once a process has opened a hand, or has tried to open one,
   every call in a child forked from it is refused with EPERM, except sun2xp_error, sun2xp_error_text,
   sun2xp_version, sun2xp_version_number, sun2xp_abi_version, sun2xp_default_hand, sun2xp_fault_text and
   sun2xp_stop_all; the parent is not affected. This applies to children of fork, of _Fork and of the
   system calls fork and clone. It also applies while handlers of pthread_atfork run. Before Linux 4.14 it
   applies only to children of fork, and only after these handlers have run. A child that shares the memory
   of its parent (vfork) may only call exec. A child that calls exec starts afresh. A hand that is closed
   releases its ports even if forked children are alive. If the program ends without closing, its ports
   stay locked until those children have ended too.

   Descriptors: a daemon must detach before it opens a hand, because detaching forks. The library's
   descriptors close at exec. Their numbers are 512 or more if the limit (ulimit -n) permits it. A program
   that closes only lower numbers, as many daemons do up to 255, keeps its hands. If a program closes all
   descriptors, its fingers fault with SUN2XP_FAULT_PORT_CLOSED or SUN2XP_FAULT_PORT_VANISHED. The library
   does not touch files that the program then opens under these numbers. To start a hand again, close and
   open it.

   Exit: when a program exits with hands open, an exit handler of the library brings the fingers to their
   end state (hand.end_state), as closing does. The first opening registers that handler (atexit). Exit
   handlers that the program registers later run before it and find the hands open. Those registered earlier
   run after it and find the hands closed: calls that only read still work, and calls that would open or move
   a hand are refused with ESHUTDOWN.

   A program that is killed or calls _exit leaves the motors to the boards, which receive no more commands
   and enter the configured end state. If the last thread of a process ends by pthread_exit with a hand
   open, the library ends the process within some seconds, as exit (0) does. dlclose does not unload the
   library, and the hands stay open.


   6. SERVO AND REAL TIME

   By default each finger has its own servo thread, which runs 1000 times a second under SCHED_FIFO and
   with locked memory. If finger.core is configured, the thread runs on this core. If the system does not
   permit SCHED_FIFO, locked memory or this core, opening follows hand.real_time:

       "try"      the hand works without what the system refuses, with the jitter of an ordinary process; a
                  message and sun2xp_status report that
       "enforce"  opening is refused, and sun2xp_error_text says what to change
       "ignore"   opening does not try to get real time

   RLIMIT_RTTIME (ulimit -R) limits how long a thread under SCHED_FIFO may run without waiting. A servo
   waits in every cycle, but the system counts the time in ticks of up to 10 ms. Set the limit to 100000
   (microseconds) or more, or to unlimited, or set hand.real_time to "ignore".

   The command `sun2xp doctor` examines a machine and says what to change. sun2xp_timing reports where the
   time of a cycle goes. */

#ifndef SUN2XP_HANDLES_H
#define SUN2XP_HANDLES_H

#include <stddef.h>

/* The structs have the library's layout even after #pragma pack of the program. */
#if defined(__clang__) || defined(__GNUC__)
#pragma pack(push, 16)
#endif

/* Some calls have the name of their struct. -Wshadow of g++ warns that such a call hides a constructor. */
#if defined(__cplusplus) && defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* An open hand. The library never dereferences a handle, and refuses one that belongs to no open hand. */
typedef struct sun2xp_hand sun2xp_hand;

/* The version of this header. Compare with sun2xp_version_number. */
#define SUN2XP_VERSION "0.1.0"
#define SUN2XP_VERSION_MAJOR 0
#define SUN2XP_VERSION_MINOR 1
#define SUN2XP_VERSION_PATCH 0
#define SUN2XP_VERSION_NUMBER 100

#define SUN2XP_ALL_FINGERS 0                /* Stands for all fingers of a hand. Only the calls whose entries say so
                                               accept this number. */
#define SUN2XP_ERROR_DEFECT 1               /* The library has a defect. Please report it. */
#define SUN2XP_ERROR_FORKED 2               /* The process is a forked child, which has no servo threads. */
#define SUN2XP_ERROR_EXITING 3              /* The process is exiting, and its hands are closed. */
#define SUN2XP_ERROR_NO_HAND 4              /* The handle does not belong to an open hand. */
#define SUN2XP_ERROR_BUSY 5                 /* Hand or finger is busy. It is being opened, closed, calibrated or
                                               recovered; or the finger left its pose while sun2xp_send_path computed
                                               a path that begins at this pose; or 16 groups of sun2xp_send_group
                                               have not taken effect yet. Call again later. If a finger is limp
                                               (SUN2XP_STATE_LIMP), zero it first. Three other calls get this number
                                               too: OpenHand while its hand is open, sun2xp_set_log in the log
                                               callback, and a call for a hand on another machine if another client
                                               commands this hand. */
#define SUN2XP_ERROR_TOO_MANY 6             /* Too many hands or reflexes. */
#define SUN2XP_ERROR_ARGUMENT 7             /* An argument makes no sense: null, NaN, no such finger, a struct that
                                               is too small. */
#define SUN2XP_ERROR_LIMIT 8                /* An argument is outside the limits of the finger (out of reach, too
                                               fast, too stiff), or it is a matrix that cannot be the stiffness of a
                                               spring. */
#define SUN2XP_ERROR_FAULTED 9              /* The finger has stopped because of a fault. */
#define SUN2XP_ERROR_CONFIGURATION 10       /* The configuration cannot be read, used, changed or stored. */
#define SUN2XP_ERROR_PORT 11                /* A port, a board or the connection to another machine does not work. A
                                               refusal of sun2xp_recover has this number too if the servo gets no
                                               processor time and therefore does not release its port. */
#define SUN2XP_ERROR_SYSTEM 12              /* The system refuses a thread, a file or another resource. */
#define SUN2XP_ERROR_NO_MEMORY 13           /* There is not enough memory. */
#define SUN2XP_ERROR_TIMED_OUT 14           /* The time limit has expired. */
#define SUN2XP_ERROR_CALIBRATION 15         /* A calibration failed. */
#define SUN2XP_ERROR_NOT_SUPPORTED 16       /* The hand lacks what the call needs, such as a simulated finger or
                                               object. */
#define SUN2XP_ERROR_NOT_FOUND 17           /* There is no such record or reflex. */
#define SUN2XP_ERROR_REAL_TIME 18           /* hand.real_time is "enforce", and real time is not available. */


/* ---- ERRORS ------------------------------------------------------------------------------------------------------ */

/*
 A refused call (sun2xp_error). The texts are valid until the next refused call of the same thread.

 The member remedy names only calls that open or close a hand, sun2xp_recover, sun2xp_zero and sun2xp_status. It may
 be empty although another call helps. The member text always contains the whole remedy.
 */
struct sun2xp_error {
    size_t size;                            /* sizeof (struct sun2xp_error), set before the call. */
    int number;                             /* SUN2XP_ERROR_..., or 0 if no call was refused. */
    int system_errno;                       /* errno of the refusal. */
    const char *call;                       /* Name of the call; never null. */
    const char *text;                       /* One line with the call, the cause and the remedy; never null. */
    const char *remedy;                     /* Calls that help, separated by commas; may be empty; never null. */
};

/*
 sun2xp_error - the last refused call of the calling thread

   hand    a hand, open or closed; null: any hand
   error   result; set error->size before the call

 Every thread has its own refusals. A thread remembers the last refusal of each of the four hands that
 have refused its calls most recently. Calls without a handle, such as sun2xp_open, and calls with a null
 handle together count as one hand. sun2xp_error returns their refusal only if hand is null. A call that
 succeeds does not change the refusals.

 Returns 0, or -SUN2XP_ERROR_ARGUMENT if error is null or error->size is too small. Never sets errno.

 Threads: any. Works in a forked child too.

 Example:

     struct sun2xp_error error;
     error.size = sizeof error;
     if (sun2xp_error(hand, &error) == 0 && error.number == SUN2XP_ERROR_FAULTED)
         fprintf(stderr, "%s\n", error.text);
 */
int sun2xp_error(const sun2xp_hand *hand, struct sun2xp_error *error);

/*
 sun2xp_error_text - the text of the last refused call of the calling thread

   hand   a hand, open or closed; null: any hand

 Returns the text of sun2xp_error, or an empty string if no call was refused. The pointer is never
 null, and is valid until the next refused call of the same thread.

 Threads: any. Works in a forked child too.
 */
const char *sun2xp_error_text(const sun2xp_hand *hand);


/* ---- MESSAGES ---------------------------------------------------------------------------------------------------- */

#define SUN2XP_LOG_REFUSAL 1                /* A call was refused. */
#define SUN2XP_LOG_WARNING 2                /* The library continues, but not as the user may expect. */

/*
 A function that receives messages. Its arguments are the severity (SUN2XP_LOG_...), one line of text, and
 the argument user of sun2xp_set_log.
 */
typedef void (*sun2xp_log)(int severity, const char *text, void *user);

/*
 sun2xp_set_log - receive the messages of the library

   callback   function to call with each message; null: messages go to standard error again
   user       third argument of each call of the function

 If there is a callback, the library calls it with each message, and prints nothing, except while
 sun2xp_set_log replaces the callback. The library calls it in a thread whose call is refused, and in
 threads of the library that are not real-time, for example in the one that opens a hand. Of the refusals,
 only the first of each kind in a process is a message. If hand.print_refusals is false for a hand, the
 refusals of calls for this hand are no messages. Several threads may call the callback at the same time.
 The callback must make no calls of the library, and must return. The text is valid only until the
 callback returns. There is one callback for all hands of the process.

 When sun2xp_set_log has returned, the previous callback is not running and is not called again. A message
 that comes while sun2xp_set_log waits for the previous callback is printed.

 Returns 0, or a negative number with
   EPERM    forked child
   EBUSY    the callback itself makes this call

 Threads: any. Waits until the previous callback has returned.
 */
int sun2xp_set_log(sun2xp_log callback, void *user);


/* ---- VERSIONS ---------------------------------------------------------------------------------------------------- */

#define SUN2XP_ABI_VERSION 0                /* This number rises only when programs must be compiled again. */

/*
 sun2xp_version - the version of the library that runs

 Returns a text such as "0.1.0", which stays valid. SUN2XP_VERSION is the version of the header.

 Threads: any. Works in a forked child too.
 */
const char *sun2xp_version(void);

/*
 sun2xp_version_number - the version as a number that increases with each version

 Returns 10000 times the major, plus 100 times the minor, plus the patch number.
 SUN2XP_VERSION_NUMBER is the same number for the header.

 Threads: any. Works in a forked child too.
 */
unsigned int sun2xp_version_number(void);

/*
 sun2xp_abi_version - the number of the binary interface

 A program must not use the library if this number differs from the program's SUN2XP_ABI_VERSION. The number is part
 of the name of the shared library, so only a program that loads the library by dlopen needs this comparison.

 Threads: any. Works in a forked child too.
 */
unsigned int sun2xp_abi_version(void);


/* ---- OPENING AND CLOSING ----------------------------------------------------------------------------------------- */

/*
 sun2xp_open - open the hand of a configuration file

   path   the file; null: the file that OpenHand finds (docs/configuration.md), or the simulated hand if
          OpenHand finds none
   hand   result: the handle of the hand

 Opens the ports, starts the servos and brings the tendons under tension. Returns when every finger has
 answered and holds its present pose at the configured initial stiffness. Takes at most about a second
 for a simulated hand. At most 16 hands can be open at once, in addition to the hand of OpenHand.

 Returns 0, or a negative number with
   EPERM    forked child
   ENOMEM   there is not enough memory
   EFAULT   hand is null
   EMFILE   16 hands are open
   ENOENT, EACCES ...  the configuration file cannot be read; errno of the system
   EINVAL   the configuration is unusable; sun2xp_error_text names file, line and reason
   ENOENT, EACCES, EBUSY ...  a port cannot be opened; errno of the system
   ETIMEDOUT ...  a board does not answer, or the device is not a board. The errno is ENODEV if the board
            that finger.board names is not found, or is found at several ports
   EIO      the tendons of a finger do not come under tension in time, the finger faults before that, or
            the self-test finds wrong wiring (hand.self_test)
   EPERM, ENOMEM, EINVAL ...  hand.real_time is "enforce", and SCHED_FIFO, locked memory or the
            configured core is not available

 Threads: any. Several threads may open hands at the same time.

 Example:

     sun2xp_hand *other;
     if (sun2xp_open(NULL, &other) != 0) {
         fprintf(stderr, "%s\n", sun2xp_error_text(NULL));
         exit(1);
     }
 */
int sun2xp_open(const char *path, sun2xp_hand **hand);

/*
 sun2xp_open_text - open the hand of a configuration in memory

   configuration   the text, as in a configuration file (TOML, UTF-8)
   hand            result: the handle of the hand

 A finger for which the text names neither a port nor a board is simulated. A text is refused if it
 leaves one finger simulated in this way and names a real port or board for another finger.
 Calibration results are in force until the hand is closed, and are not stored.

 Returns 0, or a negative number with
   EPERM    forked child
   EFAULT   configuration or hand is null
   others   as sun2xp_open

 Threads: any.

 Example, a hand of 500 cycles a second:

     sun2xp_hand *other;
     sun2xp_open_text("[hand]\nrate = 500\n", &other);
     sun2xp_close(other);
 */
int sun2xp_open_text(const char *configuration, sun2xp_hand **hand);

/*
 sun2xp_open_named - open a simulated hand by its name

   name   "nominal", "worn", "sheathed" or "cheap": what the simulated tendons, gauges and motors are
          like (docs/real-tendons.md)
   hand   result: the handle of the hand

 Returns 0, or a negative number with
   EPERM    forked child
   EFAULT   name or hand is null
   EINVAL   no hand has this name
   others   as sun2xp_open

 Threads: any.

 Example:

     sun2xp_hand *other;
     sun2xp_open_named("nominal", &other);
     sun2xp_close(other);
 */
int sun2xp_open_named(const char *name, sun2xp_hand **hand);

/*
 sun2xp_close - stop a hand

 Brings every finger to the configured end state (hand.end_state) and stops the servos, as CloseHand does.
 Afterwards the handle does not belong to an open hand. No later hand has the same handle, except on 32-bit
 machines, where a handle can occur again after 65536 further hands. At exit the library closes all hands
 that are still open.

 Returns 0, or a negative number with
   EPERM    forked child
   ENODEV   no such hand, or another thread is closing it already (the call does not wait for the end)
   EBUSY    only in an event callback (sun2xp_on_event) of any hand: another thread is just beginning to
            close this hand, or the process exits

 Threads: any. Waits until the callback of this hand has returned, unless the call was made in an event
 callback of any hand.
 */
int sun2xp_close(sun2xp_hand *hand);

/*
 sun2xp_default_hand - the hand that OpenHand has opened

 Returns the handle, or null if that hand is not open. CloseHand and sun2xp_close close it.

 Threads: any. Works in a forked child too.
 */
sun2xp_hand *sun2xp_default_hand(void);


/* ---- HARDWARE OF THE PROGRAM ------------------------------------------------------------------------------------- */

#define SUN2XP_IO_WATCHDOG 1                /* The watchdog of the hardware has tripped since the library last called
                                               start (struct sun2xp_io). */
#define SUN2XP_IO_ENDED 2                   /* The hardware has entered the end state, but not by its watchdog. */
#define SUN2XP_IO_EMERGENCY_STOP 4          /* The emergency stop is active. */
#define SUN2XP_IO_SUPPLY 8                  /* The supply of the motors is missing or out of range. */
#define SUN2XP_IO_DRIVER 16                 /* A motor driver reports a fault. */
#define SUN2XP_IO_SENSOR 32                 /* An encoder or a gauge cannot be read. */
#define SUN2XP_IO_ZERO_LOST 64              /* The encoder counts have lost their reference to the zero. If start
                                               sets this bit when the hand is opened, the finger does not fault while
                                               the bit stays set: a message reports it, and the finger must be zeroed
                                               (sun2xp_zero). */

/* The terms under which the motors of a finger may move. The library sets all members. */
struct sun2xp_io_terms {
    size_t size;                            /* sizeof (struct sun2xp_io_terms) in the library. */
    int finger;                             /* Finger, 1 to 3. */
    int hold;                               /* 1: the end state is "hold"; 0: it is "release". sun2xp_stop_all
                                               explains both. */
    double rate;                            /* Exchanges per second, Hz. */
    double watchdog;                        /* Time without an exchange after which the hardware must enter the end
                                               state by itself, s. */
    double hold_time;                       /* Duration of "hold", s. */
    double hold_torque;                     /* Largest torque that "hold" keeps, N cm. */
    double torque_limits[4];                /* Largest torque of each motor, N cm. No commanded torque is larger. */
    double torque_constants[4];             /* Torque constant of each motor, N cm/A. */
};

/*
 What the sensors of a finger measured. Before the library calls start or exchange, it sets size, and sets all other
 members to 0.
 */
struct sun2xp_io_sample {
    size_t size;                            /* sizeof (struct sun2xp_io_sample) in the library. */
    double time;                            /* Time of the measurement, s of any clock that advances evenly. 0 stands
                                               for the time at which the exchange returned. */
    double tensions[4];                     /* Tensions at the gauges, N. */
    int encoders[4];                        /* Counts of the motor encoders. */
    unsigned int faults;                    /* Sum of the SUN2XP_IO_... bits of all present faults. Each bit stops
                                               the finger with a fault, with one exception: SUN2XP_IO_ZERO_LOST does
                                               not stop the finger if every sample since the call of start at opening
                                               has had this bit. */
};

/* The command of one exchange. The library sets all members. */
struct sun2xp_io_command {
    size_t size;                            /* sizeof (struct sun2xp_io_command) in the library. */
    unsigned long number;                   /* Number of the command, counted from the last call of start. If an
                                               exchange fails and the member in_step of struct sun2xp_io is 1, the
                                               library repeats the exchange with the same number. */
    int enable;                             /* 0: the motors must be off, and the torques are zero. */
    double torques[4];                      /* Torques of motors 1 to 4, N cm. */
    double deadline;                        /* Time by which the exchange should return, s of CLOCK_MONOTONIC. */
};

/* The hardware of one finger (sun2xp_open_io). Set unused members to 0. */
struct sun2xp_io {
    size_t size;                            /* sizeof (struct sun2xp_io), the same in every element of an array. */
    int finger;                             /* Finger, 1 to 3. */
    int holds;                              /* 1: the hardware supports the end state "hold". */
    int in_step;                            /* 1: the hardware is a simulation that advances by one period in each
                                               exchange. The servo waits for the simulation. */
    double shortest_watchdog;               /* Shortest watchdog time that the hardware supports, s. */
    double tension_unit;                    /* Resolution with which the library stores tensions, N. 0 selects 0.005
                                               N. */
    void *user;                             /* First argument of the functions. */
    int (*start)(void*, const struct sun2xp_io_terms*, struct sun2xp_io_sample*); /* Prepares the hardware, with the
                                               motors off, and gets the first sample. */
    int (*exchange)(void*, const struct sun2xp_io_command*, struct sun2xp_io_sample*); /* Applies the torques, and
                                               gets what the sensors measure. */
    int (*stop)(void*);                     /* Enters the end state. */
};

/*
 sun2xp_open_io - open a hand with hardware that the program provides

   path    as in sun2xp_open
   count   number of fingers whose hardware the program provides, 0 to 3
   io      io[count]: the hardware of each of these fingers; copied
   hand    result: the handle of the hand

 Opens a hand as sun2xp_open does. A finger with an element in io has no serial port: the library calls
 start, then exchange in every cycle, then stop, all with user as first argument. Each must return 0, or an
 errno if it fails. Timing, faults and recovery are as with a board (docs/other-hardware.md). The library
 calls these functions as follows:

   start     in a thread of the library that is not real-time, at opening and at every recovery. start
             may take seconds. If it fails, the opening or the recovery is refused.
   exchange  in the servo thread of the finger. A failure counts as a lost reply. If exchange returns 0
             after the deadline, the sample is used nevertheless. If the next period has begun by then,
             the cycle counts as an overrun.
   stop      in the servo thread. At a recovery, or when opening is refused, it may be called in a thread
             that is not real-time. If stop fails, the library calls it again. If it keeps failing, the
             library calls it at least three times in all. Every start that has succeeded is followed by
             a stop.

 Calls for one finger never overlap. Calls for different fingers may overlap. If the fingers share a
 servo thread (finger.thread), their exchanges do not overlap, but a start, or the stop of a recovery,
 may overlap with the exchange of another finger. In one cycle, these fingers get the same
 command->deadline. The next cycle has a later one, so a new deadline marks the first exchange of a
 cycle. A finger that is faulted or stopped gets no exchange.

 exchange and stop must not allocate memory, wait for locks, write files or call the library. The behaviour
 is undefined if one of the functions does not return, because of longjmp, pthread_exit or an exception.

 The program must provide a watchdog outside this process, such as that of its drives: if no exchange
 comes for the time terms->watchdog, the hardware must enter the end state by itself, even if this
 process hangs or has died.

 A tension may be from -8191 to 57342 times io->tension_unit. A tension that is NaN or outside this range
 faults the finger, as SUN2XP_IO_SENSOR does. An encoder that moves by more than 32767
 counts between two exchanges faults the finger in the same way.

 Returns 0, or a negative number with
   EPERM    forked child
   ENOMEM   there is not enough memory
   EFAULT   hand is null, or io is null and count is not 0
   EINVAL   size is too small; count is not 0 to 3; no such finger, or two elements for one finger;
            shortest_watchdog is negative or NaN
   EFAULT   a function of io is null
   EMFILE   16 hands are open
   ENOENT, EACCES ...  the configuration file cannot be read; errno of the system
   EINVAL   the configuration is unusable; finger.gauge.newton_per_count or finger.gauge.zero does not fit
            this hardware (docs/other-hardware.md); tension_unit is negative, infinite or NaN
   others   as sun2xp_open, and the errno that start has returned

 Threads: any.
 */
int sun2xp_open_io(const char *path, int count, const struct sun2xp_io *io, sun2xp_hand **hand);

/*
 sun2xp_open_io_text - sun2xp_open_io for a configuration in memory

   configuration   the text, as in sun2xp_open_text
   count, io       as in sun2xp_open_io
   hand            result: the handle of the hand

 Returns 0, or a negative number with
   EPERM    forked child
   EFAULT   hand or configuration is null, or io is null and count is not 0
   others   as sun2xp_open_io

 Threads: any.
 */
int sun2xp_open_io_text(const char *configuration, int count, const struct sun2xp_io *io, sun2xp_hand **hand);


/* ---- JOINT ANGLES AND STIFFNESS ---------------------------------------------------------------------------------- */

/*
 sun2xp_send_position - send desired joint angles to a finger

   finger     1 to 3
   position   position[3]: desired angles of joints 0, 1, 2, rad

 All three angles take effect together. From the next cycle on, the anchor of the fingertip's spring (the
 point toward which the spring pulls) moves to the angles in position, along a straight line in joint
 angles and at a bounded speed. The stiffness Kx is the one sent last (sun2xp_send_stiffness). When the
 anchor has arrived, the force of the fingertip is Kx (tip - p) at any distance: tip is the place of the
 fingertip at the angles in position, and p is the present place of the fingertip. With
 finger.controller.law = "report" the finger follows the law of the report, which holds for small
 distances. The call does not wait until the finger arrives. sun2xp_limits reads the joint limits.

 Returns 0, or a negative number with
   EPERM    forked child
   EFAULT   position is null
   ENODEV   no such hand
   EINVAL   no such finger; an angle is NaN or infinite
   ERANGE   an angle is outside the joint limits (hand.out_of_range = "clamp" clamps it instead)
   EIO      the finger is faulted

 Threads: any. Never waits for a servo. Takes about 100 ns.

 Example:

     double position[3] = {0.0, 0.5, 0.8};
     sun2xp_send_position(hand, 1, position);
 */
int sun2xp_send_position(sun2xp_hand *hand, int finger, const double *position);

/*
 sun2xp_send_stiffness - set the stiffness of a fingertip

   finger      1 to 3
   stiffness   stiffness[9] or &stiffness[0][0] of stiffness[3][3], row by row: entry [row][column] is
               the force along axis row (x, y, z of the finger's frame) for a displacement of 1 cm
               along axis column, N/cm

 Sets Kx, the stiffness of the fingertip. All entries begin to change in the next cycle, without a jump in
 torque: 95 % of the change has taken effect after 50 ms. The matrix must be symmetric; two mirrored entries
 that differ by up to 1e-3 of the largest entry are averaged. No eigenvalue may be below -1e-3 times the
 largest one. The matrix may be singular or zero: along directions without stiffness the finger is limp but
 still damped. The largest eigenvalue may be at most the configured bound, by default 6 N/cm if the servo
 rate (hand.rate) is 1000 Hz or more, and 5 N/cm otherwise.

 Returns 0, or a negative number with
   EPERM    forked child
   EFAULT   stiffness is null
   ENODEV   no such hand
   EINVAL   no such finger; an entry is NaN or infinite
   EDOM     the matrix is not symmetric, or has a negative eigenvalue
   ERANGE   the matrix is stiffer than the bound (hand.out_of_range = "clamp" clamps it instead)
   EIO      the finger is faulted
   ERANGE   the matrix is too stiff for the ratio of sun2xp_send_damping ("clamp" clamps the ratio)

 Threads: any. Never waits for a servo. Takes about 1 us.

 Example, softer along z:

     double stiffness[9] = {3, 0, 0, 0, 3, 0, 0, 0, 1};
     sun2xp_send_stiffness(hand, 1, stiffness);
 */
int sun2xp_send_stiffness(sun2xp_hand *hand, int finger, const double *stiffness);

/*
 sun2xp_position - read the joint angles of a finger

   finger     1 to 3
   position   result: position[3]: measured angles of joints 0, 1, 2, rad, from the last cycle

 While the servo thread does not run, the angles stay those of its last cycle, and the member
 skipped_periods of sun2xp_status grows.

 Returns 0, or a negative number with
   EPERM    forked child
   EFAULT   position is null
   ENODEV   no such hand
   EINVAL   no such finger
   EIO      the finger is faulted

 Threads: any. Never waits for a servo. Takes about 100 ns.

 Example:

     double position[3];
     if (sun2xp_position(hand, 2, position) == 0)
         printf("%g %g %g\n", position[0], position[1], position[2]);
 */
int sun2xp_position(sun2xp_hand *hand, int finger, double *position);


/* ---- FINGERTIPS -------------------------------------------------------------------------------------------------- */

/*
 Result of sun2xp_tip. Vectors are in the finger's frame.

 The member force is computed from the measured tensions, so it includes friction, weight and inertia of
 the finger. This member is never NaN. Near singular poses there are directions in which a force on the
 tip causes almost no joint torque, so that the force cannot be computed from the joint torques. Along
 these directions, the members force and stiffness are zero. The member contact_force does not contain
 constant errors of the gauges. The member stiffness is the part of Kx, or of the joint stiffness, that
 the present pose admits, plus three other stiffnesses: that of the spring that pushes a joint back from
 beyond its limit, that of the spring that holds joint 0 while the tip is near the axis of this joint, and
 the rotational stiffness of a contact. After a change of Kx, this member has its new value in the next
 cycle, although the stiffness of the finger itself changes over 50 ms. The members contact_force,
 stiffness and touching are zero while the finger is not running. The member slide_speed is 0 while the
 member touching is 0. While touching is 1, the tip slides on the object at this speed, or tip and object
 move together at this speed.
 */
struct sun2xp_tip {
    size_t size;                            /* sizeof (struct sun2xp_tip), set before the call. */
    int force_directions;                   /* Number of directions in which the member force can be computed, 0 to
                                               3. */
    double position[3];                     /* Position of the tip: x, y, z, cm. */
    double force[3];                        /* Force of the tip on an object, with friction, weight, inertia: x, y,
                                               z, N. */
    double tensions[4];                     /* Measured tendon tensions, N. */
    double stiffness[3][3];                 /* Stiffness of the tip in its present pose, N/cm, row by row. */
    double contact_force[3];                /* Force of the tip on an object, without friction, weight, inertia: x,
                                               y, z, N. */
    double slide_speed;                     /* Speed of the tip perpendicular to contact_force, cm/s. */
    int touching;                           /* 1: tensions and motion show that the finger touches something. */
};

/*
 sun2xp_send_tip - send a desired fingertip position to a finger

   finger   1 to 3
   tip      tip[3]: desired x, y, z of the tip in the finger's frame (chapter 3), cm

 From the next cycle on, the anchor of the fingertip's spring moves to tip, along a straight line in joint
 angles and at a bounded speed. The stiffness Kx is the one sent last (sun2xp_send_stiffness). When the
 anchor is at tip and p is the position of the fingertip, the force is Kx (tip - p) at any distance,
 whatever the configured finger.controller.law. If several joint solutions are within the joint limits, the
 call takes the one nearest to the present pose.

 Returns 0, or a negative number with
   EPERM    forked child
   EFAULT   tip is null
   ENODEV   no such hand
   EINVAL   no such finger; an entry is NaN or infinite
   ERANGE   tip is too far, too near, or outside the joint limits; it is never clamped
   EIO      the finger is faulted

 Threads: any. Never waits for a servo. Takes less than 1 us.

 Example:

     double tip[3] = {0.0, -6.0, 8.0};
     sun2xp_send_tip(hand, 1, tip);
 */
int sun2xp_send_tip(sun2xp_hand *hand, int finger, const double *tip);

/*
 sun2xp_tip - read position, force and stiffness of a fingertip, and the tendon tensions

   finger   1 to 3
   tip      result, from the last cycle of the servo; set tip->size before the call

 Returns 0, or a negative number with
   EPERM    forked child
   EFAULT   tip is null
   ENODEV   no such hand
   EINVAL   size is too small; no such finger
   EIO      the finger is faulted

 Threads: any. Never waits for a servo. Takes about 1 us.

 Example:

     struct sun2xp_tip tip;
     tip.size = sizeof tip;
     if (sun2xp_tip(hand, 1, &tip) == 0)
         printf("%g N along z\n", tip.force[2]);
 */
int sun2xp_tip(sun2xp_hand *hand, int finger, struct sun2xp_tip *tip);

/*
 sun2xp_send_contact - give a fingertip the stiffness of a contact type

   finger       1 to 3
   dimensions   number of dimensions of the contact (section 4.2 of the report):
                1   frictionless point: a force along the normal
                3   hard finger with friction: three forces; the same as sun2xp_send_stiffness
                4   soft finger: three forces and a moment about the normal
   stiffness    a matrix of dimensions x dimensions, row by row. 1: N/cm along the normal. 3 and 4: rows
                and columns 0 to 2 are x, y, z of the finger's frame, N/cm. 4: row 3 and column 3 belong
                to the rotation about the normal: the entry on the diagonal is in N cm/rad, the other
                entries of this row and column are in N/rad
   normal       normal[3]: the contact normal in the finger's frame, of any length but zero. Not used
                for 3 dimensions, and may be null there

 The contact takes effect as a whole, without a jump in torque. It replaces the stiffness sent last,
 and a later sun2xp_send_stiffness replaces it. In directions in which the contact exerts no force, the
 finger is limp but still damped. The matrix must be symmetric and must have no negative eigenvalue, as for
 sun2xp_send_stiffness. For the comparison with the bound, a rotational stiffness of k N cm/rad is
 converted to k / (l2 l2) N/cm, where l2 is the length of the last link.

 A soft finger is not a spring in four independent directions, because three joints cannot turn the tip
 without moving it. If the tip moves by a vector v, cm, it turns about normal by the dot product c . v,
 rad. The vector c depends on the pose. A rotational stiffness of k N cm/rad therefore stiffens the tip
 along c, by k |c| |c| N/cm, and the tip exerts no moment that is independent of its force. In the pose
 0, 0.5, 0.8 rad the example below gives 3.24, 3 and 3 N/cm along x, y and z. With normal along x it
 gives 3, 3.56 and 4.87 N/cm, and -1.02 N/cm between y and z. sun2xp_tip reads the stiffness that
 results.

 Returns 0, or a negative number with
   EPERM    forked child
   EFAULT   stiffness is null; normal is null for 1 or 4 dimensions
   ENODEV   no such hand
   EINVAL   no such finger; dimensions is not 1, 3 or 4; an entry is NaN or infinite
   EDOM     stiffness is not symmetric, or has a negative eigenvalue; normal is zero
   ERANGE   stiffness is stiffer than the bound (hand.out_of_range = "clamp" clamps it instead)
   EIO      the finger is faulted
   ERANGE   stiffness is too stiff for the ratio of sun2xp_send_damping ("clamp" clamps the ratio
            instead)

 Threads: any. Never waits for a servo. Takes a few us.

 Example, a soft finger:

     double stiffness[4][4] = {{3, 0, 0, 0}, {0, 3, 0, 0}, {0, 0, 3, 0}, {0, 0, 0, 20}};
     double normal[3] = {0, -1, 0};
     sun2xp_send_contact(hand, 1, 4, &stiffness[0][0], normal);
 */
int sun2xp_send_contact(sun2xp_hand *hand, int finger, int dimensions, const double *stiffness, const double *normal);

/*
 sun2xp_send_damping - set the damping of a fingertip

   finger   1 to 3
   ratio    damping relative to the damping that the controller chooses for the stiffness; 1 after sun2xp_open

 The ratio changes without a jump in torque and stays until another ratio is sent. It becomes 1 again when
 the finger becomes a spring after a fault or a calibration, when a set point expires, and when a reflex
 with the reaction SUN2XP_THEN_SOFTEN fires. A reflex with SUN2XP_THEN_DAMP replaces the ratio. A finger
 whose ratio is much below or much above 1 does not come to rest. The permitted range depends on the
 controller (finger.controller.scheme: state feedback, or figure 9, 10 or 11 of the report), the servo
 rate (hand.rate) and the largest eigenvalue k of the stiffness, N/cm:

                                     1000 Hz and above    below 1000 Hz
   state feedback         smallest   0.40 + 0.09 k        0.70 + 0.07 k
                          largest    2.10 - 0.19 k        2.00 - 0.20 k
   figures 9, 10, 11      smallest   1                    1
                          largest    2.50 - 0.22 k        2.00 - 0.20 k

 The limits are rounded inward to multiples of 0.01: with 1.5 N/cm the largest ratio is 1.81, not 1.815.
 By default the range is 0.67 to 1.53 at 3 N/cm and 0.94 to 1 at 6 N/cm. If the smallest ratio of the
 table is above 1, or the largest is below 1, the limit is 1 instead: 1 is always admitted. For a
 finger with other links or tendons, k is first multiplied by 12.3 N/cm divided by S. S is the smallest
 stiffness that the tendons give the tip in any direction, with locked motors and with the joints in the
 middle of their ranges. For the default finger S is 12.3 N/cm. For the stiffness of
 sun2xp_send_joint_stiffness, k is its largest eigenvalue divided by l2 l2, where l2 is the length of the
 last link. While a path changes Kx, k is that of the stiffest Kx from the beginning to the end of the
 path. Every call that sends a stiffness is refused if the range for this stiffness does not include the
 ratio sent last. With hand.out_of_range = "clamp" the ratio is clamped instead.

 Returns 0, or a negative number with
   EPERM    forked child
   ENODEV   no such hand
   EINVAL   no such finger; ratio is NaN or infinite
   EIO      the finger is faulted
   ERANGE   ratio is outside the range that sun2xp_error_text gives (hand.out_of_range = "clamp" clamps
            it)

 Threads: any. Never waits for a servo. Takes about 100 ns.
 */
int sun2xp_send_damping(sun2xp_hand *hand, int finger, double ratio);


/* ---- SPRINGS IN JOINT ANGLES ------------------------------------------------------------------------------------- */

/*
 sun2xp_send_joint_stiffness - turn the joints of a finger into springs

   finger      1 to 3
   stiffness   stiffness[9] or &stiffness[0][0] of stiffness[3][3], row by row: entry [i][j] is the
               torque of joint i for a deflection of joint j from its set point, N cm/rad

 The torque of the joints is stiffness (d - p), with the desired angles d and the measured angles p of
 joints 0, 1 and 2. The stiffness takes effect like Kx, without a jump in torque: 95 % of the change has
 taken effect after 50 ms. It replaces the Kx or contact that was sent last. A later sun2xp_send_stiffness
 or sun2xp_send_contact replaces it, and so does a Kx of sun2xp_send_group or sun2xp_send_path. The torque
 of sun2xp_send_joint_torque stays. The stiffness must be symmetric and must have no negative eigenvalue,
 as for sun2xp_send_stiffness. It may be zero.

 The largest eigenvalue may be at most the bound of Kx times the square of the length of the last
 link: by default 96 N cm/rad if the servo rate (hand.rate) is 1000 Hz or more, and 80 N cm/rad
 otherwise. This is the stiffness that a Kx with all eigenvalues at its bound gives joint 2 in every pose.

 Returns 0, or a negative number with
   EPERM    forked child
   EFAULT   stiffness is null
   ENODEV   no such hand
   EINVAL   no such finger; an entry is NaN or infinite
   EDOM     stiffness is not symmetric, or has a negative eigenvalue
   ERANGE   stiffness is stiffer than the bound (hand.out_of_range = "clamp" clamps it instead)
   EIO      the finger is faulted
   ERANGE   stiffness is too stiff for the ratio of sun2xp_send_damping ("clamp" clamps the ratio
            instead)

 Threads: any. Never waits for a servo. Takes a few us.

 Example:

     double stiffness[3][3] = {{80, 0, 0}, {0, 80, 0}, {0, 0, 50}};
     sun2xp_send_joint_stiffness(hand, 1, &stiffness[0][0]);
 */
int sun2xp_send_joint_stiffness(sun2xp_hand *hand, int finger, const double *stiffness);

/*
 sun2xp_send_joint_torque - add a constant torque to the joints of a finger

   finger   1 to 3
   torque   torque[3]: torque of joints 0, 1, 2, N cm; positive torques increase the angles

 The torque acts in addition to the spring of Kx, of a contact or of sun2xp_send_joint_stiffness, until
 the next sun2xp_send_joint_torque replaces it; zero ends it. The torque takes effect like Kx, without a
 jump. If the stiffness is zero, the finger is controlled by torque alone: a free finger then moves to its
 joint limits, at a speed that only damping and friction limit. The torque also ends at a fault, at a
 calibration, when a set point expires, and when a reflex holds, retracts or softens the finger.

 A torque is refused if it needs more tension than a tendon and its motor permit. If the spring, the
 compensation of gravity and the torque together need more, the servo scales their sum down.

 Returns 0, or a negative number with
   EPERM    forked child
   EFAULT   torque is null
   ENODEV   no such hand
   EINVAL   no such finger; a torque is NaN or infinite
   ERANGE   the tendons cannot produce this torque (hand.out_of_range = "clamp" scales it instead)
   EIO      the finger is faulted

 Threads: any. Never waits for a servo. Takes about 1 us.

 Example:

     double torque[3] = {0, 3, 1.5};
     sun2xp_send_joint_torque(hand, 1, torque);
 */
int sun2xp_send_joint_torque(sun2xp_hand *hand, int finger, const double *torque);


/* ---- GROUPS AND WAITING ------------------------------------------------------------------------------------------ */

#define SUN2XP_WAIT_ARRIVED 1               /* Since the set point that was sent last took effect, there was a cycle
                                               in which every joint was within finger.events.arrived_degrees of this
                                               set point. */
#define SUN2XP_WAIT_SETTLED 2               /* Since the set point that was sent last took effect, there was a time
                                               of finger.events.settled_ms in which no joint moved by more than
                                               finger.events.settled_degrees. */

/* Command to one finger of a group (sun2xp_send_group). */
struct sun2xp_set_point {
    size_t size;                            /* sizeof (struct sun2xp_set_point), the same in every set point. */
    int finger;                             /* Finger, 1 to 3. */
    const double *position;                 /* Angles of sun2xp_send_position. Null: the member tip gives the pose,
                                               or the pose stays. */
    const double *tip;                      /* Position of sun2xp_send_tip. Null: the member position gives the pose,
                                               or the pose stays. */
    const double *stiffness;                /* Matrix of sun2xp_send_stiffness. Null: the stiffness stays. */
    double damping;                         /* Ratio of sun2xp_send_damping. 0: the damping stays. */
};

/*
 sun2xp_send_group - command several fingers in the same cycle

   count        number of commands, 0 to 3
   set_points   set_points[count]: one command for each finger of the group, in any order; set size of
                every command, and set unused members to 0

 Each command has the effect of sun2xp_send_position or sun2xp_send_tip, sun2xp_send_stiffness and
 sun2xp_send_damping. All fingers of the group follow their commands from the same cycle on, even if
 different threads serve them. The periods of the servos are numbered for the whole hand, and the group
 takes effect in the same period for every finger, at most two periods after the call. If the call is
 refused, no finger gets its command.

 If a servo is so late that it skips this period, its finger follows in its next cycle. With hand.clock =
 "board" the cycles of a thread follow the clock of its board, but the periods are counted by the host's
 clock. So the cycles skip or repeat a period now and then, and a group may then take effect one period
 later in the fingers of this thread.

 Returns 0, or a negative number with
   EPERM    forked child
   EFAULT   set_points is null, and count is not 0
   ENODEV   no such hand
   EINVAL   size is too small; count is not 0 to 3; no such finger; two commands for one finger, or
            position and tip for one finger; an entry is NaN or infinite
   EDOM, ERANGE  as sun2xp_send_position, sun2xp_send_tip and sun2xp_send_stiffness
   EIO      a finger of the group is faulted
   ERANGE   a ratio is outside the range of sun2xp_send_damping, or a stiffness is too stiff for the ratio
            (hand.out_of_range = "clamp" clamps the ratio)
   EBUSY    16 groups of a finger have not taken effect yet, because the program sends more
            than one in each period, or because the servo does not run

 Threads: any. Never waits for a servo. Takes a few us.

 Example, two fingers close together:

     double position_1[3] = {0.0, 0.5, 0.8}, position_2[3] = {0.0, 0.6, 0.9};
     static struct sun2xp_set_point set_points[2];

     set_points[0].size = set_points[1].size = sizeof set_points[0];
     set_points[0].finger = 1;
     set_points[0].position = position_1;
     set_points[1].finger = 2;
     set_points[1].position = position_2;
     sun2xp_send_group(hand, 2, set_points);
 */
int sun2xp_send_group(sun2xp_hand *hand, int count, const struct sun2xp_set_point *set_points);

/*
 sun2xp_wait - wait until fingers have arrived or settled

   finger    1 to 3, or SUN2XP_ALL_FINGERS
   until     SUN2XP_WAIT_ARRIVED or SUN2XP_WAIT_SETTLED
   seconds   longest time to wait

 If the condition holds already, the call returns at once. With SUN2XP_ALL_FINGERS the condition must hold
 for each finger and its own set point. The fingers may arrive or settle in different cycles. A finger that
 an object blocks settles without arriving. If the set point is a position of the tip, the finger arrives
 at the joint angles that were computed for it. If a reflex has replaced the set point that was sent last,
 the condition must hold for the set point of the reflex. This is also so if the finger ignored a later set
 point because the reflex inhibits set points for some time. In this case the wait returns only after that
 time. If the set point that was sent last has expired, the condition must be true for the pose in which the
 finger has stayed since then. The event SUN2XP_EVENT_REFLEX_FIRED reports the reaction of a reflex, and the
 event SUN2XP_EVENT_EXPIRED reports that a set point has expired. Other calls work during the wait.
 sun2xp_close works too, and then the wait is refused.

 Returns 0, or a negative number with
   EPERM    forked child
   ENODEV   no such hand, or it was closed meanwhile
   EINVAL   no such finger; until is neither of the two constants; seconds is negative or NaN
   EIO      a finger is faulted
   EBUSY    a finger is limp or is being calibrated, or the process is exiting (SUN2XP_STATE_CLOSED)
   ETIMEDOUT  the time has expired; sun2xp_error_text names a finger that has not arrived or settled

 Threads: any.

 Example:

     if (sun2xp_wait(hand, SUN2XP_ALL_FINGERS, SUN2XP_WAIT_SETTLED, 5.0) != 0)
         fprintf(stderr, "%s\n", sun2xp_error_text(hand));
 */
int sun2xp_wait(sun2xp_hand *hand, int finger, int until, double seconds);


/* ---- PATHS ------------------------------------------------------------------------------------------------------- */

/*
 Pose of a path (sun2xp_send_path).

 The member is_tip must be the same in every pose of a path.
 */
struct sun2xp_path_pose {
    size_t size;                            /* sizeof (struct sun2xp_path_pose), the same in every pose of the path. */
    int is_tip;                             /* 0: the member place holds joint angles. 1: it holds a position of the
                                               tip. */
    double time;                            /* Time since the beginning of the path, s. */
    double place[3];                        /* Joint angles, rad, or x, y, z of the tip in the finger's frame, cm. */
    const double *stiffness;                /* Matrix Kx of sun2xp_send_stiffness. Null: the pose has no Kx. */
};

/*
 sun2xp_send_path - send a timed path to a finger

   finger    1 to 3
   count     number of poses, 1 to 128
   poses     poses[count], in the order of their times; set size of every pose
   seconds   how long the path stays valid after its end, s; 0 for finger.motion.valid_ms

 The path begins at once. Its first point is the present place of the anchor of the fingertip's spring,
 and the path continues the anchor's motion. It passes every pose at its time and rests at the last one.
 Between poses the joint angles, or the tip, follow a spline. If the path begins at rest and its only pose
 is a position of the tip, the tip moves along a straight line. Speed, acceleration and jerk are
 continuous, with one exception: if a path from the present motion would violate a limit, the finger first
 brakes for 0.15 s. The braking begins with the present speed, but without acceleration and jerk. The
 controller "state feedback" (finger.controller.scheme) smooths this step in acceleration and jerk. This
 controller also feeds speed, acceleration and jerk forward, so the finger follows without the lag of
 sun2xp_send_position.

 Between two poses that have a Kx, Kx changes linearly. Until the first pose that has a Kx, Kx changes
 linearly from its value at the beginning of the path. After sun2xp_send_joint_stiffness this value is 0,
 and the joint stiffness ends when a path with a Kx begins. So call sun2xp_send_stiffness before such a
 path. A path without a Kx leaves the joint stiffness as it is.

 The whole path is checked before anything moves: against the joint limits, and against speed,
 acceleration and jerk of finger.motion. With hand.out_of_range = "clamp" joint angles and Kx are clamped,
 and a path that is too fast is made slower as a whole. A path that is out of reach, or that is outside the
 joint limits between two poses, is refused nevertheless. Another path, sun2xp_send_position or
 sun2xp_send_tip replaces the path without a jump, even while the finger follows it. A Kx that is sent
 while a path runs takes effect at once, and the path no longer changes Kx. After a refused call the finger
 continues as before.

 Returns 0, or a negative number with
   EPERM    forked child
   EFAULT   poses is null
   ENOMEM   there is not enough memory for the computation
   ENODEV   no such hand
   EINVAL   size is too small; count is not 1 to 128; seconds is NaN, negative or more than 3600; no such
            finger; a time is more than 3600 s, or less than 1 ms later than that of the pose before it
            (0 for the first pose); joint angles and tip positions are mixed; an entry is NaN or infinite
   EDOM     a Kx is not symmetric, or has a negative eigenvalue
   ERANGE   a pose or a place between two poses is out of reach or outside the joint limits, a Kx is too
            stiff, or the path is too fast; sun2xp_error_text names the pose. If the path is too
            fast, the text also gives the factor by which it must be slower
   EIO      the finger is faulted
   EBUSY    the finger is being recovered or calibrated, or is limp
   EAGAIN   during the call the finger was recovered or calibrated, its set point expired, a reflex reacted,
            or the inhibition of a reflex ended. Send the path again
   ERANGE   a Kx is too stiff for the ratio of sun2xp_send_damping ("clamp" clamps the ratio instead)

 Threads: any. Never waits for a servo. Takes about 1 ms, depending on the number of poses.

 Example:

     static struct sun2xp_path_pose poses[2];

     poses[0].size = poses[1].size = sizeof poses[0];
     poses[0].time = 0.5;
     poses[0].place[1] = 0.5, poses[0].place[2] = 0.8;
     poses[1].time = 1.0;
     poses[1].place[1] = 0.7, poses[1].place[2] = 1.1;
     if (sun2xp_send_path(hand, 1, 2, poses, 0) != 0)
         fprintf(stderr, "%s\n", sun2xp_error_text(hand));
 */
int sun2xp_send_path(sun2xp_hand *hand, int finger, int count, const struct sun2xp_path_pose *poses, double seconds);

/*
 sun2xp_send_position_for - send desired joint angles that expire

   finger     1 to 3
   position   position[3]: desired angles of joints 0, 1, 2, rad, as for sun2xp_send_position
   seconds    how long the angles are valid, s; 0 for finger.motion.valid_ms

 Has the effect of sun2xp_send_position. If the time given by seconds passes without another command to
 the finger, the finger no longer follows the angles. By default it then holds its present pose, with the
 soft stiffness finger.motion.expired_stiffness. With finger.motion.on_expiry = "end state" it faults.

 Returns 0, or a negative number with
   EPERM    forked child
   EFAULT   position is null
   ENODEV   no such hand
   EINVAL   seconds is NaN, negative or more than 3600; no such finger; an angle is NaN or infinite
   ERANGE   an angle is outside the joint limits (hand.out_of_range = "clamp" clamps it instead)
   EIO      the finger is faulted

 Threads: any. Never waits for a servo. Takes about 200 ns.

 Example, from a planner that sends every 20 ms:

     double position[3] = {0.0, 0.5, 0.8};
     sun2xp_send_position_for(hand, 1, position, 0.06);
 */
int sun2xp_send_position_for(sun2xp_hand *hand, int finger, const double *position, double seconds);


/* ---- KINEMATICS AND GRAVITY -------------------------------------------------------------------------------------- */

/* Result of sun2xp_joint_torques. */
struct sun2xp_joint_torques {
    size_t size;                            /* sizeof (struct sun2xp_joint_torques), set before the call. */
    double measured[3];                     /* Torques from the measured tensions: joints 0, 1, 2, N cm. */
    double commanded[3];                    /* Torques that the servo commands, N cm, within the tension limits. */
};

/* Result of sun2xp_palm_pose. Positions and axes are in the palm's frame. */
struct sun2xp_palm_pose {
    size_t size;                            /* sizeof (struct sun2xp_palm_pose), set before the call. */
    double base[3];                         /* Origin of the finger's frame: x, y, z, cm. */
    double rotation[3][3];                  /* Matrix, row by row. Its columns are the axes of the finger's frame. */
    double tip[3];                          /* Position of the tip, from the measured joint angles: x, y, z, cm. */
    double tip_rotation[3][3];              /* Axes of the last link as columns; z points to the tip. */
};

/*
 sun2xp_jacobian - compute the Jacobian of a fingertip

   finger     1 to 3
   position   position[3]: angles of joints 0, 1, 2, rad. Null: the measured angles
   jacobian   result: jacobian[9], row by row: entry [row][column] is the motion of the tip
              along axis row (x, y, z of the finger's frame) when joint column turns, cm/rad (eq. 8 of the report)

 A force f on the tip, N, exerts this torque on joint k, N cm: entry [0][k] times f[0], plus entry [1][k]
 times f[1], plus entry [2][k] times f[2].

 Returns 0, or a negative number with
   EPERM    forked child
   EFAULT   jacobian is null
   ENODEV   no such hand
   EINVAL   no such finger; an angle is NaN or infinite
   EIO      position is null and the finger is faulted

 Threads: any. Never waits for a servo.

 Example:

     double jacobian[3][3];
     if (sun2xp_jacobian(hand, 1, NULL, &jacobian[0][0]) == 0)
         printf("%g cm/rad\n", jacobian[0][0]);
 */
int sun2xp_jacobian(sun2xp_hand *hand, int finger, const double *position, double *jacobian);

/*
 sun2xp_forward_kinematics - compute where a tip is at given joint angles

   finger     1 to 3
   position   position[3]: angles of joints 0, 1, 2, rad; they may be outside the joint limits
   tip        result: tip[3]: x, y, z of the tip in the finger's frame, cm

 Returns 0, or a negative number with
   EPERM    forked child
   EFAULT   position or tip is null
   ENODEV   no such hand
   EINVAL   no such finger; an angle is NaN or infinite

 Threads: any. Never waits for a servo.

 Example:

     double position[3] = {0.0, 0.5, 0.8}, tip[3];
     sun2xp_forward_kinematics(hand, 1, position, tip);
 */
int sun2xp_forward_kinematics(sun2xp_hand *hand, int finger, const double *position, double *tip);

/*
 sun2xp_inverse_kinematics - compute the joint angles at which a tip is at a position

   finger     1 to 3
   tip        tip[3]: x, y, z of the tip in the finger's frame, cm
   position   result: position[3]: angles of joints 0, 1, 2, rad

 If several joint solutions are within the joint limits, the result is the one nearest to the present
 pose, as with sun2xp_send_tip.

 Returns 0, or a negative number with
   EPERM    forked child
   EFAULT   tip or position is null
   ENODEV   no such hand
   EINVAL   no such finger; an entry is NaN or infinite
   ERANGE   tip is too far, too near, or outside the joint limits

 Threads: any. Never waits for a servo.

 Example:

     double tip[3] = {0.0, -6.0, 8.0}, position[3];
     if (sun2xp_inverse_kinematics(hand, 1, tip, position) == 0)
         printf("%g %g %g\n", position[0], position[1], position[2]);
 */
int sun2xp_inverse_kinematics(sun2xp_hand *hand, int finger, const double *tip, double *position);

/*
 sun2xp_joint_torques - read the joint torques of a finger

   finger    1 to 3
   torques   result, from the last cycle of the servo; set torques->size before the call

 Returns 0, or a negative number with
   EPERM    forked child
   EFAULT   torques is null
   ENODEV   no such hand
   EINVAL   size is too small; no such finger
   EIO      the finger is faulted

 Threads: any. Never waits for a servo.
 */
int sun2xp_joint_torques(sun2xp_hand *hand, int finger, struct sun2xp_joint_torques *torques);

/*
 sun2xp_palm_pose - read where a finger and its tip are in the palm

   finger   1 to 3
   pose     result, from the last cycle of the servo; set pose->size before the call

 The members base and rotation follow from finger.base and finger.turn_degrees of the configuration. By
 default two fingers are side by side, and the thumb is opposite to them.

 Returns 0, or a negative number with
   EPERM    forked child
   EFAULT   pose is null
   ENODEV   no such hand
   EINVAL   size is too small; no such finger
   EIO      the finger is faulted

 Threads: any. Never waits for a servo.
 */
int sun2xp_palm_pose(sun2xp_hand *hand, int finger, struct sun2xp_palm_pose *pose);

/*
 sun2xp_set_gravity - set gravity in the palm's frame, for a hand on a moving arm

   gravity   gravity[3]: gravity along x, y, z of the palm's frame, m/s^2

 Replaces hand.gravity until sun2xp_close. Every finger that compensates gravity compensates the new one
 within a cycle (finger.controller.gravity_compensation, default true). If gravity changes by more than
 2 m/s^2 in a millisecond, this takes several cycles, so that the torque does not jump. The new gravity
 also acts on simulated fingers and on a simulated object. Gravity is an input of the servos, as a set
 point is, so a planner can send it in every cycle.

 Returns 0, or a negative number with
   EPERM    forked child
   EFAULT   gravity is null
   ENODEV   no such hand
   EINVAL   an entry is NaN, infinite or beyond 100 m/s^2
   EIO      a finger is faulted; the other fingers have the new gravity, and this finger takes it when
            it recovers

 Threads: any. Never waits for a servo. Takes a few us; a simulated finger may keep the call waiting while
 it computes.

 Example, a palm whose x axis points down:

     double gravity[3] = {9.81, 0, 0};
     sun2xp_set_gravity(hand, gravity);
 */
int sun2xp_set_gravity(sun2xp_hand *hand, const double *gravity);


/* ---- LIMITS ------------------------------------------------------------------------------------------------------ */

/* Result of sun2xp_limits. */
struct sun2xp_limits {
    size_t size;                            /* sizeof (struct sun2xp_limits), set before the call. */
    double joint_minimum[3];                /* Smallest angles of joints 0, 1, 2, rad. */
    double joint_maximum[3];                /* Largest angles of joints 0, 1, 2, rad. */
    double tension_minimum;                 /* Smallest tension of a tendon, N. */
    double tension_maximum;                 /* Largest tension of a tendon, N. */
    double motor_torque[4];                 /* Largest torques of the motors, N cm. */
    double stiffness;                       /* Largest permitted eigenvalue of a stiffness, N/cm. */
};

/*
 sun2xp_limits - read the limits of a finger

   finger   1 to 3
   limits   result; set limits->size before the call

 The limits come from the configuration. sun2xp_adjust can change all of them except motor_torque.

 Returns 0, or a negative number with
   EPERM    forked child
   EFAULT   limits is null
   ENODEV   no such hand
   EINVAL   size is too small; no such finger

 Threads: any. Never waits for a servo.

 Example:

     struct sun2xp_limits limits;
     limits.size = sizeof limits;
     if (sun2xp_limits(hand, 1, &limits) == 0)
         printf("joint 1 bends to %g rad\n", limits.joint_maximum[1]);
 */
int sun2xp_limits(sun2xp_hand *hand, int finger, struct sun2xp_limits *limits);


/* ---- TOUCH ------------------------------------------------------------------------------------------------------- */

/*
 Result of sun2xp_touch.

 If the member valid is 0, the members pressed, count and force are 0 too. The member force is the member count minus
 the zero of the element, times newton_per_count of the configuration. Tactile events are lost if they do not fit
 into the queue of the board, or if their element is not configured.
 */
struct sun2xp_touch {
    size_t size;                            /* sizeof (struct sun2xp_touch), set before the call. */
    int valid;                              /* 1: the newest report of this element has a reading. 0: it has none, or
                                               the board has not reported the element since sun2xp_open or since its
                                               last reset. */
    int pressed;                            /* 1 if something presses the element, otherwise 0. */
    unsigned int count;                     /* The raw count of the element. */
    double force;                           /* Force on the element, N. */
    unsigned long lost_events;              /* Tactile events of the finger that were lost since sun2xp_open. */
};

/*
 sun2xp_touch - the newest reading of a tactile element

   finger    1 to 3
   element   element, from 0, in the order of [finger.touch] in the configuration
   touch     result; set touch->size before the call

 A board reports a changed reading of an element as an event. The servo fetches one event of a finger in
 each period in which the line has time for it. A faulted finger keeps its last readings. They become
 invalid when the finger recovers, if the board may have been reset: after SUN2XP_FAULT_BOARD_RESET,
 SUN2XP_FAULT_LOST_REPLIES, SUN2XP_FAULT_DAMAGED_REPLIES, SUN2XP_FAULT_PORT_VANISHED and
 SUN2XP_FAULT_PORT_FAILED, and after any other fault if the board was reset before the recovery.

 Returns 0, or a negative number with
   EPERM    forked child
   EFAULT   touch is null
   ENODEV   no such hand
   EINVAL   size is too small; no such finger; no such element

 Threads: any. Never waits for a servo. Takes a few us.

 Example:

     struct sun2xp_touch touch;
     touch.size = sizeof touch;
     if (sun2xp_touch(hand, 1, 0, &touch) == 0 && touch.valid)
         printf("%.3f N\n", touch.force);
 */
int sun2xp_touch(sun2xp_hand *hand, int finger, int element, struct sun2xp_touch *touch);

/*
 sun2xp_tare_touch - make the present readings of a finger's tactile elements their zeros

   finger   1 to 3

 Call sun2xp_tare_touch while nothing touches the finger. An element without a valid reading keeps its
 zero. The zeros are in force until sun2xp_close. The configuration keeps its own zeros.

 Returns 0, or a negative number with
   EPERM    forked child
   ENODEV   no such hand
   EINVAL   no such finger

 Threads: any. Never waits for a servo. Takes a few us.

 Example:

     sun2xp_tare_touch(hand, 1);
 */
int sun2xp_tare_touch(sun2xp_hand *hand, int finger);


/* ---- SIMULATION -------------------------------------------------------------------------------------------------- */

/*
 Result of sun2xp_object. Vectors are in the palm's frame.

 The member time stops while the machine is too busy for the simulation. The member rotation is the unit
 matrix at the start. The member force comes from the simulation and not from the gauges. It is zero for a
 finger that does not touch the object.
 */
struct sun2xp_object {
    size_t size;                            /* sizeof (struct sun2xp_object), set before the call. */
    int touching;                           /* Number of fingers that touch the object. */
    double time;                            /* Simulated time since sun2xp_open, s. */
    double position[3];                     /* Position of the centre: x, y, z, cm. */
    double rotation[3][3];                  /* Rotation from the object's frame to the palm's, row by row. */
    double velocity[3];                     /* Velocity of the centre, cm/s. */
    double angular_velocity[3];             /* Angular velocity, rad/s. */
    double force[3][3];                     /* True force of each finger on the object, N; [0]: finger 1. */
};

/*
 sun2xp_object - read pose and motion of the object in the simulated hand

   object   result, at most some milliseconds old; set object->size before the call

 If hand.simulated_object is configured, the hand has one object that all simulated fingers can touch: a
 ball or a box with mass and friction. It can lie on a table. hand.gravity also acts on the object.

 Returns 0, or a negative number with
   EPERM    forked child
   EFAULT   object is null
   ENODEV   no such hand
   EINVAL   size is too small
   ENOTSUP  no object is configured; no finger is simulated

 Threads: any. Never waits for a servo or for the simulation. Takes less than 1 us.

 Example:

     struct sun2xp_object object;
     object.size = sizeof object;
     if (sun2xp_object(hand, &object) == 0)
         printf("z is %g cm, %d fingers touch\n", object.position[2], object.touching);
 */
int sun2xp_object(sun2xp_hand *hand, struct sun2xp_object *object);

/*
 sun2xp_push - push the fingertip of a simulated finger

   finger   1 to 3
   force    force[3]: force on the fingertip along x, y, z of the finger's frame, N. It
            acts until the next sun2xp_push for this finger; zero ends it

 Returns 0, or a negative number with
   EPERM    forked child
   EFAULT   force is null
   ENODEV   no such hand
   EINVAL   no such finger; an entry is NaN or infinite
   ENOTSUP  the finger is not simulated by the library
   ERANGE   a component is beyond 1000 N

 Threads: any.
 */
int sun2xp_push(sun2xp_hand *hand, int finger, const double *force);


/* ---- ADJUSTMENT -------------------------------------------------------------------------------------------------- */

/*
 sun2xp_adjust - change the configuration of a finger while it runs

   finger   1 to 3
   keys     lines of TOML, in UTF-8, as under [finger.i] of the configuration file (docs/sun2xp.toml)

 All keys take effect together, within a cycle and without a jump in torque; other keys stay as they are.
 The change lasts until sun2xp_close: the file is not written. A new controller.law applies to set points
 and paths in joint angles that are sent after the call. These keys cannot change while the hand is open:
 port, board, baud, reconnect, address, thread, core, priority, base, turn_degrees, encoder, motor.sign,
 motor.torque_limit, motor.torque_constant, stiffness.initial, touch and simulation.

 A configured stiffness.bound was chosen for the configured controller.scheme. If the lines in keys
 change controller.scheme but do not set stiffness.bound, the smaller of the configured bound and the
 default bound applies. If the bound is lowered while a path changes Kx, the Kx of the end of the path
 takes effect at once.

 If the path that was sent last has not ended, the call checks the whole path against the new limits, except
 those of finger.motion, which apply only to later paths. The check includes the part that the finger has
 already followed. With hand.out_of_range = "clamp" a path outside the new joint limits ends, and the finger
 moves to the end of the path at once. A finger that was beyond a joint limit when it became a spring may
 still hold its pose there. The call accepts this pose, unless the new limit is narrower.

 Returns 0, or a negative number with
   EPERM    forked child
   EFAULT   keys is null
   ENODEV   no such hand
   EINVAL   no such finger; keys is not TOML
   EBUSY    a key cannot change while the hand is open
   EINVAL   an unknown key; an unusable configuration
   ERANGE   the position, path, stiffness, torque or damping sent last is outside the new limits
            (hand.out_of_range = "clamp" clamps it instead)
   EIO      the finger is faulted

 Threads: any. Never waits for a servo. Takes about 200 us, and allocates memory.

 Example:

     sun2xp_adjust(hand, 1, "tendon.minimum = 6\ncontroller.tension_gain = 3");
 */
int sun2xp_adjust(sun2xp_hand *hand, int finger, const char *keys);


/* ---- STATUS ------------------------------------------------------------------------------------------------------ */

#define SUN2XP_STATE_RUNNING 1              /* The fingertip is the spring that the planner has commanded. */
#define SUN2XP_STATE_FAULTED 2              /* The finger has stopped because of a fault. Its motors are in the
                                               configured end state. Calls that command the finger or read its pose
                                               are refused with EIO until sun2xp_recover, or sun2xp_close and
                                               sun2xp_open. */
#define SUN2XP_STATE_LIMP 3                 /* The motors are off after a failed calibration. Set points have no
                                               effect. The finger becomes a spring again after another calibration,
                                               or after sun2xp_close and sun2xp_open. */
#define SUN2XP_STATE_CALIBRATING 4          /* sun2xp_zero or sun2xp_identify moves the finger. Set points have no
                                               effect. */
#define SUN2XP_STATE_TENSIONING 5           /* sun2xp_open, sun2xp_recover or the end of a calibration brings the
                                               tendons under tension. Set points have no effect. */
#define SUN2XP_STATE_CLOSED 6               /* The process exits without sun2xp_close, and the finger goes to its
                                               configured end state or is already there. Only exit handlers and
                                               remaining threads see this state. */

/*
 Result of sun2xp_status.

 The member measured_rate is the number of cycles divided by the time from sun2xp_open to this call: the
 rate falls while the servo does not run. The members wake_up_median, wake_up_p99 and wake_up_maximum
 cover the cycles since sun2xp_open or the last sun2xp_reset_timing. The member torque_scale applies to
 all joints alike, so the torque keeps its direction. The member stiffness_scale is below 1 in poses in
 which the tendons cannot provide the whole Kx, for example near the straight pose. A joint beyond its
 limit can also reduce stiffness_scale, because the spring that pushes the joint back needs a part of what
 the tendons provide. sun2xp_tip gives the stiffness that results.
 */
struct sun2xp_status {
    size_t size;                            /* sizeof (struct sun2xp_status), set before the call. */
    int state;                              /* SUN2XP_STATE_RUNNING to SUN2XP_STATE_CLOSED. */
    int realtime;                           /* 1: all servo threads of the hand run under SCHED_FIFO. */
    double rate;                            /* Configured servo rate, Hz. */
    double measured_rate;                   /* Measured servo rate since sun2xp_open, Hz. */
    double wake_up_median;                  /* Median delay of the start of a cycle, us (jitter). */
    double wake_up_p99;                     /* Delay that 99 of 100 cycles did not exceed, us. */
    double wake_up_maximum;                 /* Maximum delay, us. */
    double torque_scale;                    /* Fraction of the desired joint torque that the tension limits permitted
                                               in the last cycle, 0 to 1. */
    unsigned long cycles;                   /* Cycles since sun2xp_open. */
    unsigned long skipped_periods;          /* Whole periods, up to now, in which no cycle began because the previous
                                               cycle was not over or the servo thread did not run. One late cycle may
                                               skip many. */
    unsigned long lost_replies;             /* Cycles without a valid reply in time. */
    unsigned long damaged_replies;          /* Pieces of bad data on the finger's port: damaged frames, truncated
                                               frames and noise. Whole frames that no finger expected count in
                                               sun2xp_timing.foreign_frames. */
    double calibration;                     /* Progress of a calibration, 0 to 1. It is 0 if no calibration runs. */
    int memory_locked;                      /* 1: sun2xp_open has locked the memory of every servo thread, so that no
                                               servo thread waits for a page. If the planner calls munlockall later,
                                               this memory is unlocked too, and this member stays 1. If the hand is
                                               closed and opened again, sun2xp_open locks the memory again. 0: the
                                               memory of at least one servo thread is not locked. */
    int on_core;                            /* 1: each servo thread with a configured core runs on this core. */
    double stiffness_scale;                 /* Fraction of Kx that was in force in the last cycle, 0 to 1. */
};

/*
 sun2xp_status - rate, jitter and losses of a finger's servo

   finger   1 to 3
   status   result; set status->size before the call

 Works on a faulted finger too. A servo thread does not run while a thread with a higher priority
 occupies its core, or while a debugger stops it. Meanwhile the members state and cycles keep the values
 of the last cycle, and the member skipped_periods grows by 1 in every period. A planner can therefore
 compare skipped_periods with an earlier value to compute how old the pose of sun2xp_position is.

 Returns 0, or a negative number with
   EPERM    forked child
   EFAULT   status is null
   ENODEV   no such hand
   EINVAL   size is too small; no such finger

 Threads: any.

 Example:

     struct sun2xp_status status;
     status.size = sizeof status;
     if (sun2xp_status(hand, 1, &status) == 0)
         printf("%.1f Hz\n", status.measured_rate);
 */
int sun2xp_status(sun2xp_hand *hand, int finger, struct sun2xp_status *status);


/* ---- TIMING ------------------------------------------------------------------------------------------------------ */

#define SUN2XP_STAGE_WAKE_UP 0              /* From the scheduled start of a cycle to the thread's first instruction. */
#define SUN2XP_STAGE_WRITE 1                /* Passing the commands of the port's fingers to the operating system. */
#define SUN2XP_STAGE_WIRE 2                 /* From the end of SUN2XP_STAGE_WRITE until the reply can be read: the
                                               line in both directions, and the board. */
#define SUN2XP_STAGE_READ 3                 /* Reading the reply. */
#define SUN2XP_STAGE_DECODE 4               /* Decoding the bytes to the finger's reply, including all checks. */
#define SUN2XP_STAGE_COMPUTE 5              /* Computing the command, and the state that planners read. */
#define SUN2XP_STAGE_CYCLE 6                /* From the scheduled start of a cycle to the end of its computation. */
#define SUN2XP_STAGE_AGE 7                  /* Age of the newest measurement when the command computed from it takes
                                               effect, by the board's clock. It is one period if nothing is late. */

/*
 Result of sun2xp_timing. All times are in ns, accurate to 1 %, at most 4.29e9, and 0 if no cycle had the
 stage. All values count from sun2xp_open or the last sun2xp_reset_timing of the finger.
 */
struct sun2xp_timing {
    size_t size;                            /* sizeof (struct sun2xp_timing), set before the call. */
    int stage;                              /* The requested stage. */
    unsigned long count;                    /* Cycles that had this stage. */
    unsigned long minimum;                  /* Shortest time of the stage. */
    unsigned long median;                   /* Half of the cycles took no longer. */
    unsigned long p99;                      /* 99 of 100 cycles took no longer. */
    unsigned long p999;                     /* 999 of 1000 cycles took no longer. */
    unsigned long maximum;                  /* Longest time of the stage. */
    unsigned long cycles;                   /* All cycles of the finger. This member and all later ones do not depend
                                               on the stage. */
    unsigned long overruns;                 /* Cycles that were not over when the next one was due. */
    unsigned long skipped_periods;          /* Whole periods, up to the last cycle, in which no cycle began because
                                               the previous cycle was not over or the servo thread did not run. */
    unsigned long lost_replies;             /* Cycles without a valid reply in time. */
    unsigned long late_replies;             /* Replies that arrived after the end of their cycle. */
    unsigned long damaged_replies;          /* Pieces of bad data on the finger's port: damaged frames, truncated
                                               frames and noise. */
    unsigned long duplicate_replies;        /* Replies that arrived a second time. */
    unsigned long foreign_frames;           /* Whole frames on the finger's port that no finger expected. */
};

/*
 sun2xp_timing - where the time of a finger's cycles goes

   finger   1 to 3
   stage    SUN2XP_STAGE_WAKE_UP to SUN2XP_STAGE_AGE
   timing   result; set timing->size before the call

 Works while the servo runs, and on a faulted finger too.

 Returns 0, or a negative number with
   EPERM    forked child
   EFAULT   timing is null
   ENODEV   no such hand
   EINVAL   size is too small; no such finger; no such stage

 Threads: any. Never waits for a servo. Takes a few us.

 Example:

     struct sun2xp_timing timing;
     timing.size = sizeof timing;
     if (sun2xp_timing(hand, 1, SUN2XP_STAGE_WIRE, &timing) == 0)
         printf("%lu ns\n", timing.p99);
 */
int sun2xp_timing(sun2xp_hand *hand, int finger, int stage, struct sun2xp_timing *timing);

/*
 sun2xp_reset_timing - restart the counts of sun2xp_timing

   finger   1 to 3, or SUN2XP_ALL_FINGERS

 The counts of sun2xp_status continue. The wake-up times of sun2xp_status restart, because they are those
 of sun2xp_timing.

 Returns 0, or a negative number with
   EPERM    forked child
   ENODEV   no such hand
   EINVAL   no such finger

 Threads: any. Never waits for a servo.
 */
int sun2xp_reset_timing(sun2xp_hand *hand, int finger);


/* ---- FAULTS ------------------------------------------------------------------------------------------------------ */

/* Faults (docs/faults.md). Numbers never change. */
#define SUN2XP_FAULT_SLACK_TENDON            1 /* slack tendon */
#define SUN2XP_FAULT_BROKEN_TENDON           2 /* broken tendon */
#define SUN2XP_FAULT_OVER_TENSION            3 /* over-tension */
#define SUN2XP_FAULT_GAUGE_STUCK             4 /* gauge stuck */
#define SUN2XP_FAULT_GAUGE_OUT_OF_RANGE      5 /* gauge out of range */
#define SUN2XP_FAULT_GAUGE_DISAGREES         6 /* gauge against encoders */
#define SUN2XP_FAULT_ENCODER_JUMP            7 /* encoder jump */
#define SUN2XP_FAULT_STALLED_MOTOR           8 /* stalled motor */
#define SUN2XP_FAULT_OVERHEATED_MOTOR        9 /* overheated motor */
#define SUN2XP_FAULT_JOINT_AT_STOP          10 /* joint at its stop */
#define SUN2XP_FAULT_IMPOSSIBLE_POSE        11 /* impossible pose */
#define SUN2XP_FAULT_SLACK_IN_MOTION        12 /* slack in motion */
#define SUN2XP_FAULT_LOST_REPLIES           13 /* lost replies */
#define SUN2XP_FAULT_DAMAGED_REPLIES        14 /* damaged replies */
#define SUN2XP_FAULT_LINE_NOISE             15 /* noise on the line */
#define SUN2XP_FAULT_WATCHDOG               16 /* watchdog */
#define SUN2XP_FAULT_BOARD_STOPPED          17 /* board stopped */
#define SUN2XP_FAULT_EMERGENCY_STOP_INPUT   18 /* emergency stop, input */
#define SUN2XP_FAULT_EMERGENCY_STOP_CALL    19 /* emergency stop, call */
#define SUN2XP_FAULT_SUPPLY_FAULT           20 /* motor supply */
#define SUN2XP_FAULT_DRIVER_FAULT           21 /* motor driver */
#define SUN2XP_FAULT_SENSOR_FAULT           22 /* sensor fault, reported by the board */
#define SUN2XP_FAULT_BOARD_RESET            23 /* board reset */
#define SUN2XP_FAULT_COMMAND_REFUSED        24 /* command refused */
#define SUN2XP_FAULT_PORT_VANISHED          25 /* port vanished */
#define SUN2XP_FAULT_PORT_FAILED            26 /* port failed */
#define SUN2XP_FAULT_PORT_MISSING           27 /* port missing */
#define SUN2XP_FAULT_PORT_BUSY              28 /* port busy */
#define SUN2XP_FAULT_PORT_PERMISSION        29 /* no permission for the port */
#define SUN2XP_FAULT_PORT_UNUSABLE          30 /* port unusable */
#define SUN2XP_FAULT_BOARD_SILENT           31 /* board silent */
#define SUN2XP_FAULT_UNINTELLIGIBLE         32 /* no protocol */
#define SUN2XP_FAULT_UNANSWERED             33 /* finger silent */
#define SUN2XP_FAULT_WRONG_VERSION          34 /* wrong protocol version */
#define SUN2XP_FAULT_WRONG_FINGER           35 /* wrong finger */
#define SUN2XP_FAULT_UNSUITABLE_BOARD       36 /* wrong board */
#define SUN2XP_FAULT_IDENTITY_CHANGED       37 /* identity changed */
#define SUN2XP_FAULT_ZERO_LOST              38 /* zero lost */
#define SUN2XP_FAULT_OVERRUN                39 /* overrun */
#define SUN2XP_FAULT_REALTIME_REFUSED       40 /* real time refused */
#define SUN2XP_FAULT_SERVO_PANIC            41 /* servo failed */
#define SUN2XP_FAULT_CURRENT_LIMIT          42 /* current limit */
#define SUN2XP_FAULT_TORQUE_NOT_ADMITTED    43 /* torque not admitted */
#define SUN2XP_FAULT_CALIBRATION_FAILED     44 /* calibration failed */
#define SUN2XP_FAULT_WARM_MOTOR             45 /* warm motor */
#define SUN2XP_FAULT_COMPANION              46 /* fault of another finger */
#define SUN2XP_FAULT_PORT_CLOSED            47 /* port closed */
#define SUN2XP_FAULT_OPENING_TIMED_OUT      48 /* opening timed out */
#define SUN2XP_FAULT_SAME_NUMBER            49 /* same number */
#define SUN2XP_FAULT_STOP_CALL              50 /* stop of the finger, call */
#define SUN2XP_FAULT_SET_POINT_EXPIRED      51 /* set point expired */
#define SUN2XP_FAULT_REFLEX_STOP            52 /* stopped by a reflex */
#define SUN2XP_FAULT_HARDWARE_FAILED        53 /* hardware failed */
#define SUN2XP_FAULT_WRONG_WIRING           54 /* wrong wiring */
/*
 Result of sun2xp_fault.

 The text of sun2xp_fault_text says which kind of part a fault concerns, for example a tendon. The member
 part or warning_part is 0 if the fault or the warning concerns the whole finger.
 */
struct sun2xp_fault {
    size_t size;                            /* sizeof (struct sun2xp_fault), set before the call. */
    int number;                             /* Fault that has stopped the finger: SUN2XP_FAULT_..., or 0 if none has. */
    int part;                               /* Number of the joint, 0 to 2, or of the tendon, motor, gauge or
                                               encoder, 1 to 4; 0 for the whole finger. */
    int warning;                            /* Newest warning of the last second: SUN2XP_FAULT_..., or 0 if there was
                                               none. If the system has refused SCHED_FIFO to the hand,
                                               SUN2XP_FAULT_REALTIME_REFUSED takes the place of 0. */
    int warning_part;                       /* Part that the warning concerns, numbered as in part. */
    double value;                           /* Value of the fault, in its unit (docs/faults.md). */
    double warning_value;                   /* Value of the warning. */
    unsigned long warnings;                 /* Warnings since sun2xp_open. A warning that persists counts once. */
};

/*
 sun2xp_fault - fault and warning of a finger

   finger   1 to 3
   fault    result; set fault->size before the call

 Returns 0, with or without a fault, or a negative number with
   EPERM    forked child
   EFAULT   fault is null
   ENODEV   no such hand
   EINVAL   size is too small; no such finger

 Threads: any. Never waits for a servo.

 Example:

     struct sun2xp_fault fault;
     fault.size = sizeof fault;
     if (sun2xp_fault(hand, 1, &fault) == 0 && fault.number != 0)
         fprintf(stderr, "finger 1: %s\n", sun2xp_fault_text(fault.number));
 */
int sun2xp_fault(sun2xp_hand *hand, int finger, struct sun2xp_fault *fault);

/*
 sun2xp_fault_text - description of a fault

   number   SUN2XP_FAULT_...

 Returns one line with the fault's name, its meaning, the likely cause and the remedy, or an empty string
 if no fault has this number. The pointer is never null, and the text stays valid until the process ends.
 If a call was refused because of a fault, sun2xp_error_text gives the same text with the part and the
 values.

 Threads: any. Works in a forked child too.
 */
const char *sun2xp_fault_text(int number);


/* ---- STOP AND RECOVERY ------------------------------------------------------------------------------------------- */

/*
 sun2xp_stop_all - emergency stop

 Every finger of every open hand faults (SUN2XP_FAULT_EMERGENCY_STOP_CALL) at the start of its next cycle. The servo
 commands its board to bring the motors of the finger into the configured end state. Calls that command the
 finger or read its pose are refused with EIO until sun2xp_recover, or sun2xp_close and sun2xp_open. A hand
 that is opened later is not affected.

 With hand.end_state = "release", the default, the torque goes to zero at once. With "hold" the motors
 keep their last torque, up to hand.hold_torque_limit, for hand.hold_time_ms, by default 2 s and at most
 a minute. Configure "hold" only for objects that must not be dropped. The torque ends earlier in three
 cases: the board detects a fault (emergency stop input, supply, driver or sensor), the board is reset or
 loses its power, or the board is configured again. sun2xp_recover configures the board again, and so does
 sun2xp_open after sun2xp_close.

 sun2xp_stop_all is not a safety function: it needs this process, this machine and the cable.

 Returns 0.

 Threads: any, and signal handlers: it is async-signal-safe, does not set errno and waits for nothing. In
 a forked child it does nothing.

 Example, for Control-C:

     static void on_interrupt(int signal)
     {
         (void)signal;
         sun2xp_stop_all();
     }

     signal(SIGINT, on_interrupt);
 */
int sun2xp_stop_all(void);

/*
 sun2xp_stop - stop a finger, or all fingers of a hand

   finger   1 to 3, or SUN2XP_ALL_FINGERS

 The finger faults (SUN2XP_FAULT_STOP_CALL) at the start of its next cycle, and its motors enter the
 configured end state, as with sun2xp_stop_all. The other fingers continue, also those on the same board,
 unless hand.on_fault is "hand". The finger stays stopped until sun2xp_recover, or sun2xp_close and
 sun2xp_open. A finger that has faulted already stays as it is. Like sun2xp_stop_all, sun2xp_stop is not a
 safety function. Unlike sun2xp_stop_all, it must not be called in a signal handler.

 Returns 0, or a negative number with
   EPERM    forked child
   ENODEV   no such hand
   EINVAL   no such finger

 Threads: any. Never waits for a servo.
 */
int sun2xp_stop(sun2xp_hand *hand, int finger);

/*
 sun2xp_recover - make a faulted finger a spring again

   finger   1 to 3, or SUN2XP_ALL_FINGERS: one after the other, up to the first that does not recover

 Queries the identity of the finger's board, configures the board again, and brings the tendons under
 tension. If the port has failed and finger.reconnect is true, the call reopens the port first. The finger
 holds its present pose at the configured initial stiffness. If another finger on the same port runs, it
 continues unchanged, and only this finger recovers. Otherwise all fingers on the port recover together,
 and the call is not refused if another one of them faults again. If the finger to be recovered is not
 faulted, the call changes nothing. It then only waits for a recovery that another call has begun. Remove
 the cause of the fault first: sun2xp_fault and sun2xp_fault_text name it.

 Waits until the finger holds its pose or faults again, up to some seconds, also if another call has begun
 the recovery. Other calls work meanwhile. sun2xp_close works too, and this call is then refused.

 Returns 0, or a negative number with
   EPERM    forked child
   ENODEV   no such hand, or it was closed meanwhile; or the port has failed and finger.reconnect
            is false
   EINVAL   no such finger
   EIO      the finger faults again; or its board is not the one found by sun2xp_open, or has lost its
            zero; or its servo thread has failed (SUN2XP_FAULT_SERVO_PANIC), which only sun2xp_close and
            sun2xp_open remedy. sun2xp_error_text gives the reason
   ENOENT, EACCES, ETIMEDOUT ...  the port is not there yet, the board does not answer, or the servo
            does not run. Call again

 Threads: any.

 Example:

     while (sun2xp_recover(hand, 1) != 0) {
         fprintf(stderr, "%s\n", sun2xp_error_text(hand));
         sleep(1);
     }
 */
int sun2xp_recover(sun2xp_hand *hand, int finger);


/* ---- CALIBRATION ------------------------------------------------------------------------------------------------- */

/*
 sun2xp_zero - find the zeros of a finger's gauges and encoders

   finger   1 to 3

 Slackens the tendons and reads the gauges. Finds the zero of the encoders by finger.zeroing.method:

   "pose"   The finger must be in the pose finger.zeroing.pose_degrees, and must stand still there from
            the start of the call until its encoders have been read. For a finger that is a spring,
            this takes 0.3 s, because its encoders are read before its tendons are slackened. For a
            limp finger, it takes some seconds. A jig or a person must hold a limp finger. A finger
            that moves is refused, and so is a limp finger that nothing holds.
   "stops"  Each joint moves slowly against both of its stops. The finger needs room for that.
   "kept"   The configured zero stays, if the board reports that its counts are still valid.

 The default is "stops" if the finger is simulated or the configuration gives the positions of its stops,
 otherwise "pose". At the end the finger holds its present pose at its initial stiffness. A free finger
 may have moved by up to some tenths of a radian while it was limp.

 The zeros take effect at once. If sun2xp_open has read a configuration file, they are written into that
 file. All its other keys and comments stay, including those that have changed since sun2xp_open. Several
 processes may store their results in one file: each waits for the others, at most 30 s.

 Waits until all this is done: some seconds, or up to a minute with "stops". Meanwhile
 sun2xp_status.calibration gives the progress, other calls work, and set points for this finger have no
 effect.

 Returns 0, or a negative number with
   EPERM      forked child
   ENODEV     no such hand, or it was closed meanwhile
   EINVAL     no such finger; or the configuration file has changed, and the zeros do not fit it:
              they are in force until sun2xp_close and not stored
   EIO        the finger is faulted. If it faulted after its zeros were found, they are in force. The next
              sun2xp_identify that succeeds for this finger stores them. If a sun2xp_zero succeeds before
              that, its own zeros replace them and are stored
   EBUSY      the finger is being calibrated or recovered already
   ECANCELED  the calibration failed (the finger moved in its pose, a tendon is slack, a gauge is dead, a
              joint meets no stop or meets it too early ...). sun2xp_error_text gives the remedy. The finger
              is then limp and has its previous zeros, with two exceptions. (1) If the finger moved while its
              encoders were read ("pose"), or if the counts were not valid ("kept"), the zeros stay, and the
              finger stays a spring or limp, as it was before the call. But a path or an interpolated motion
              (finger.motion.interpolate_ms) that it followed has ended. (2) If another thread has recovered
              the finger from a fault during the calibration, the finger holds its pose. If its new zeros
              had been found before the fault, they are in force. Otherwise its zeros have not changed
   ETIMEDOUT  not finished within finger.zeroing.time_limit_s. The effects are those of ECANCELED
   EACCES, ENOSPC, EBUSY ...  the configuration file cannot be written, or another process has kept it
              locked for 30 s. The zeros are in force until sun2xp_close. If the results of a later
              sun2xp_identify of this finger can be stored, these zeros are stored with them. A later
              sun2xp_zero that succeeds replaces them

 Threads: any.

 Example:

     if (sun2xp_zero(hand, 1) != 0)
         fprintf(stderr, "%s\n", sun2xp_error_text(hand));
 */
int sun2xp_zero(sun2xp_hand *hand, int finger);

/*
 sun2xp_identify - measure gauge gains, friction, tendon stiffness and rotor inertia of a finger

   finger   1 to 3; it must have been zeroed

 Moves the joints back and forth around their present angles, moves each joint between its two stops,
 presses against the lower stops with up to 0.6 of finger.tendon.maximum, and returns to the start.
 Measures the gains of the gauges, the stiffness of each tendon, its moment arms, the friction of motors,
 conduits, pulleys and joints, and the inertia of the rotors. The results take effect and are stored like
 those of sun2xp_zero.
 Takes about 85 s, and needs free space over the whole range of the joints.

 Returns and waits as sun2xp_zero does.

 Threads: any.
 */
int sun2xp_identify(sun2xp_hand *hand, int finger);


/* ---- EVENTS ------------------------------------------------------------------------------------------------------ */

/* Kinds of events (docs/events.md). Numbers never change. */
#define SUN2XP_EVENT_TOUCH_MADE              1 /* touch made */
#define SUN2XP_EVENT_TOUCH_LOST              2 /* touch lost */
#define SUN2XP_EVENT_TOUCH_SLIP              3 /* touch slips */
#define SUN2XP_EVENT_TOUCH_PRESSURE          4 /* touch pressure */
#define SUN2XP_EVENT_CONTACT                 5 /* contact */
#define SUN2XP_EVENT_CONTACT_LOST            6 /* contact lost */
#define SUN2XP_EVENT_SLIP                    7 /* slip */
#define SUN2XP_EVENT_TENSION_BOUND           8 /* tension bound */
#define SUN2XP_EVENT_FORCE_BOUND             9 /* force bound */
#define SUN2XP_EVENT_JOINT_AT_LIMIT         10 /* joint at limit */
#define SUN2XP_EVENT_ARRIVED                11 /* arrived */
#define SUN2XP_EVENT_SETTLED                12 /* settled */
#define SUN2XP_EVENT_FAULT                  13 /* fault */
#define SUN2XP_EVENT_WARNING                14 /* warning */
#define SUN2XP_EVENT_REFLEX_FIRED           15 /* reflex fired */
#define SUN2XP_EVENT_PATH_ENDED             16 /* path ended */
#define SUN2XP_EVENT_EXPIRED                17 /* set point expired */
#define SUN2XP_EVENT_TOUCH_INVALID          18 /* touch invalid */
/*
 An event: something that happened to a finger in one cycle of its servo.

 For each kind of event, docs/events.md says whether the member part is the number of a joint, of a tendon
 or of another part. This member is 0 if the event concerns the whole finger. All events of a cycle have the
 same time. The oldest events are lost first.
 */
struct sun2xp_event {
    size_t size;                            /* sizeof (struct sun2xp_event), set before the call. */
    int finger;                             /* Finger, 1 to 3. */
    int kind;                               /* Kind of the event: SUN2XP_EVENT_... */
    int part;                               /* Number of the joint, 0 to 2, or of the tendon, motor, gauge or
                                               encoder, 1 to 4; 0 for the whole finger. */
    unsigned long cycle;                    /* Cycle of the event, as in sun2xp_status and sun2xp_record. */
    unsigned long lost;                     /* Number of events that were lost since sun2xp_open; in a callback,
                                               since sun2xp_on_event. An event is lost if it is not taken in time. An
                                               event of a hand on another machine can also be lost on the way. */
    double time;                            /* Beginning of the event's cycle, s of CLOCK_MONOTONIC. */
    double values[4];                       /* Values, whose meaning depends on the kind (docs/events.md). Unused
                                               ones are 0. */
};

/*
 sun2xp_next_event - take the next event

   event   result; set event->size before the call

 Takes the earliest event of all fingers since sun2xp_open that no call has taken yet. Events come in the
 order of their times, except if a servo is late by more than two periods. Each finger keeps its newest
 4096 events. If they are not taken in time, the oldest are lost, and event->lost counts them. A callback
 of sun2xp_on_event takes no events: this call returns them too.

 Returns 1 if there was an event, 0 if there was none, or a negative number with
   EPERM    forked child
   EFAULT   event is null
   ENODEV   no such hand
   EINVAL   size is too small

 Threads: any; each event goes to one thread. Never waits for a servo.

 Example:

     struct sun2xp_event event;
     event.size = sizeof event;
     while (sun2xp_next_event(hand, &event) == 1)
         if (event.kind == SUN2XP_EVENT_SETTLED)
             printf("finger %d rests at %.2f s\n", event.finger, event.time);
 */
int sun2xp_next_event(sun2xp_hand *hand, struct sun2xp_event *event);

/*
 sun2xp_wait_event - wait for the next event

   event     result; set event->size before the call
   seconds   longest wait, s; 0 or NaN: no wait; negative: no limit

 Takes an event as sun2xp_next_event does, and waits for one if there is none. sun2xp_close ends the
 wait.

 Returns 1 if there was an event, 0 if there was none within the time, or a negative number with
   EPERM    forked child
   EFAULT   event is null
   ENODEV   no such hand, or it was closed meanwhile
   EINVAL   size is too small

 Threads: any; each event goes to one thread. Several threads may wait.

 Example, until finger 1 has settled:

     double position[3] = {0.0, 0.5, 0.8};
     struct sun2xp_event event;
     event.size = sizeof event;
     sun2xp_send_position(hand, 1, position);
     while (sun2xp_wait_event(hand, &event, 5.0) == 1)
         if (event.finger == 1 && event.kind == SUN2XP_EVENT_SETTLED)
             break;
 */
int sun2xp_wait_event(sun2xp_hand *hand, struct sun2xp_event *event, double seconds);

/*
 sun2xp_on_event - call a function with each event

   callback   function to call, or null for none
   context    second argument of each call of the function

 From now on a thread of the library, which is not real-time, calls callback with each event. There is
 one callback for the hand; a later sun2xp_on_event replaces it. While callback runs, later events wait.
 The callback may make every call, and must return: no longjmp, pthread_exit or exception.

 When sun2xp_on_event or sun2xp_close has returned, the previous callback is not running and is not
 called again. There is one exception: a call that is made in an event callback of any hand
 does not wait for the previous callback. The previous callback may then still be running or be called
 once more, so its context must stay valid for some time.

 Returns 0, or a negative number with
   EPERM    forked child
   ENODEV   no such hand
   EAGAIN   the system refuses to start a thread

 Threads: any. Waits until the previous callback has returned, unless the call was made in a callback, of
 this hand or of another one.

 Example:

     static void on_contact(const struct sun2xp_event *event, void *context)
     {
         (void)context;
         if (event->kind == SUN2XP_EVENT_CONTACT)
             printf("finger %d touches something\n", event->finger);
     }

     sun2xp_on_event(hand, on_contact, NULL);
 */
int sun2xp_on_event(sun2xp_hand *hand, void (*callback)(const struct sun2xp_event*, void*), void *context);

/*
 sun2xp_event_descriptor - a descriptor for poll and select

 The descriptor is readable while sun2xp_next_event would return an event, and from the beginning of
 sun2xp_close on. A call of sun2xp_next_event that returns 0 makes the descriptor unreadable. So after each
 poll, call sun2xp_next_event until it does not return 1. If it returns a negative number, the hand is being
 closed: do not poll again. Do not read, write or close the descriptor. sun2xp_close closes the descriptor as
 its last step.

 Returns the descriptor, the same one until sun2xp_close, or a negative number with
   EPERM    forked child
   ENODEV   no such hand
   EMFILE, ENFILE, EAGAIN ...  the system refuses the descriptor, or the thread that makes it readable

 Threads: any.

 Example:

     struct pollfd ready;
     struct sun2xp_event event;
     int next = 0;
     ready.fd = sun2xp_event_descriptor(hand);
     ready.events = POLLIN;
     event.size = sizeof event;
     while (next >= 0 && poll(&ready, 1, 1000) == 1)
         while ((next = sun2xp_next_event(hand, &event)) == 1)
             printf("event %d\n", event.kind);
 */
int sun2xp_event_descriptor(sun2xp_hand *hand);


/* ---- REFLEXES ---------------------------------------------------------------------------------------------------- */

#define SUN2XP_WHEN_EVENT 1                 /* An event of the finger occurs. The member named event gives its kind. */
#define SUN2XP_WHEN_OTHER_FINGER 2          /* An event of another finger occurs. The member named event gives its
                                               kind, and the member named finger gives the number of that finger. */
#define SUN2XP_WHEN_FORCE_ABOVE 3           /* The force of the surroundings on the tip (the magnitude of
                                               contact_force of sun2xp_tip) is above the value in the member bound,
                                               N. */
#define SUN2XP_WHEN_TENSION_ABOVE 4         /* The tension of any tendon is above the value in the member bound, N. */
#define SUN2XP_WHEN_TENSION_BELOW 5         /* The tension of any tendon is below the value in the member bound, N. */
#define SUN2XP_WHEN_JOINT_ABOVE 6           /* The angle of the joint with the number in the member joint is above
                                               the value in the member bound, rad. */
#define SUN2XP_WHEN_JOINT_BELOW 7           /* The angle of the joint with the number in the member joint is below
                                               the value in the member bound, rad. */
#define SUN2XP_WHEN_LINK_LOST 8             /* The board has not replied for the time in the member bound, s. */
#define SUN2XP_WHEN_PLANNER_SILENT 9        /* The planner has sent no set point for the time in the member bound, s. */
#define SUN2XP_THEN_STOP 1                  /* The finger stops with a fault. */
#define SUN2XP_THEN_HOLD 2                  /* The finger stays where it is. */
#define SUN2XP_THEN_SOFTEN 3                /* The tip gets the Kx in the member stiffness, and the damping ratio 1. */
#define SUN2XP_THEN_RETRACT 4               /* The finger goes to the joint angles in the member position. */
#define SUN2XP_THEN_GRIP 5                  /* The tip presses harder in one direction. The force of its spring in
                                               this direction rises by the amount in the member value, but to at most
                                               the amount in the member largest, both in N. This needs a Kx without
                                               an eigenvalue of 0. */
#define SUN2XP_THEN_DAMP 6                  /* The tip gets the damping ratio in the member value, or the nearest
                                               admitted ratio. */

/*
 A rule for sun2xp_install_reflex. Members that its condition and its reaction do not use are ignored.

 If the member refractory is 0, the rule fires again only after its condition has been false. If the
 member refractory is above 0, the rule also fires again after this time while its condition stays true.
 After a reaction, the finger ignores set points of the planner for the time in the member inhibition. For
 SUN2XP_THEN_GRIP, the member position is the direction in the finger's frame in which the tip presses
 harder; 0, 0, 0 stands for the direction in which its spring presses. If the component of the spring's
 force in this direction is below 0.05 N, the reaction changes no set point, but a path still ends.
 */
struct sun2xp_reflex {
    size_t size;                            /* sizeof (struct sun2xp_reflex), set before the call. */
    int condition;                          /* SUN2XP_WHEN_EVENT to SUN2XP_WHEN_PLANNER_SILENT. */
    int event;                              /* SUN2XP_EVENT_... for SUN2XP_WHEN_EVENT and SUN2XP_WHEN_OTHER_FINGER. */
    int finger;                             /* The other finger for SUN2XP_WHEN_OTHER_FINGER. */
    int joint;                              /* Joint, 0 to 2, for SUN2XP_WHEN_JOINT_ABOVE and
                                               SUN2XP_WHEN_JOINT_BELOW. */
    int reaction;                           /* SUN2XP_THEN_STOP to SUN2XP_THEN_DAMP. */
    int priority;                           /* 0 to 255. If several rules have fired, the one with the highest
                                               priority reacts first. */
    double bound;                           /* Bound of the condition: 0 to 1000 N, -pi to pi rad, or 0 to 3600 s. */
    double value;                           /* SUN2XP_THEN_GRIP: increase of the force, N, 0 to 1000.
                                               SUN2XP_THEN_DAMP: ratio, 0 to 10. */
    double largest;                         /* SUN2XP_THEN_GRIP: largest force, N, 0 to 1000. */
    double refractory;                      /* Time after a reaction in which the rule does not fire, s, 0 to 3600. */
    double inhibition;                      /* Time after a reaction in which set points are ignored, s, 0 to 3600. */
    double position[3];                     /* SUN2XP_THEN_RETRACT: joint angles, rad. SUN2XP_THEN_GRIP: direction of
                                               the force. */
    double stiffness[3][3];                 /* SUN2XP_THEN_SOFTEN: stiffness, N/cm, row by row. */
};

/*
 sun2xp_install_reflex - let a finger react by itself

   finger   1 to 3
   reflex   the rule; set reflex->size before the call

 The servo evaluates the rules of a finger in every cycle while the finger is a spring. If the condition
 becomes true, the command changes within two cycles, or within three cycles for
 SUN2XP_WHEN_OTHER_FINGER. At most one rule reacts in a cycle; the others wait. Each reaction is an event
 SUN2XP_EVENT_REFLEX_FIRED with the number of the rule. The servo of a built-in simulated finger, or of
 other hardware whose member in_step of struct sun2xp_io is set, waits for every reply, so
 SUN2XP_WHEN_LINK_LOST never becomes true for it.

 A reaction replaces the set point and ends a path. Set points that were sent before are discarded, and
 later calls that change a part of a set point start from the set point of the reaction. The next
 sun2xp_send_position moves the finger again. The set point of the reaction expires when the one that was
 sent last would have expired. The finger ignores a set point that is sent within the time in the member
 inhibition. The call that sends it is not refused, and the ignored set point still restarts the time
 after which set points expire. A rule stays until sun2xp_remove_reflex or sun2xp_close.

 Returns the number of the rule, above 0, or a negative number with
   EPERM    forked child
   EFAULT   reflex is null
   ENODEV   no such hand
   EINVAL   size is too small; no such finger, joint, condition, reaction or event; with
            SUN2XP_WHEN_OTHER_FINGER, the member finger equals the argument finger; the member position or
            stiffness is NaN or infinite
   ERANGE   another value is NaN or outside its range; sun2xp_send_position would refuse the member
            position, or sun2xp_send_stiffness the member stiffness, with ERANGE
   EDOM     sun2xp_send_stiffness would refuse the member stiffness with EDOM
   ENOSPC   the finger has 16 rules

 Threads: any. Never waits for a servo. Takes a few us.

 Example, a guarded move:

     static struct sun2xp_reflex guard;

     guard.size = sizeof guard;
     guard.condition = SUN2XP_WHEN_EVENT;
     guard.event = SUN2XP_EVENT_CONTACT;
     guard.reaction = SUN2XP_THEN_HOLD;
     if (sun2xp_install_reflex(hand, 1, &guard) < 0)
         puts(sun2xp_error_text(hand));
 */
int sun2xp_install_reflex(sun2xp_hand *hand, int finger, const struct sun2xp_reflex *reflex);

/*
 sun2xp_remove_reflex - remove a rule

   finger   1 to 3
   number   number of the rule, from sun2xp_install_reflex; 0 for all rules of the finger

 Returns 0, or a negative number with
   EPERM    forked child
   ENODEV   no such hand
   EINVAL   no such finger
   ENOENT   the finger has no rule with this number

 Threads: any. Never waits for a servo. Takes a few us.

 Example:

     sun2xp_remove_reflex(hand, 1, 0);
 */
int sun2xp_remove_reflex(sun2xp_hand *hand, int finger, int number);


/* ---- BLACK BOX --------------------------------------------------------------------------------------------------- */

/*
 Result of sun2xp_record: one cycle of a finger, from the black box.

 The library stores all cycles from the member oldest to the member newest. The controller does not run
 in a cycle in which the finger faults before the controller's turn, or in which a built-in simulated
 finger or hardware with in_step does not answer. The member computed is then 0, and so are all members
 after it.
 */
struct sun2xp_record {
    size_t size;                            /* sizeof (struct sun2xp_record), set before the call. */
    int state;                              /* SUN2XP_STATE_RUNNING to SUN2XP_STATE_CLOSED, at the end of the cycle. */
    unsigned long cycle;                    /* The cycle, counted from sun2xp_open; the first is 1. */
    unsigned long oldest;                   /* First cycle that is stored now. */
    unsigned long newest;                   /* Last cycle that is stored now. */
    double time;                            /* Start of the cycle on CLOCK_MONOTONIC, s. */
    int answered;                           /* 1: the board's reply arrived in this cycle. 0: no reply arrived. */
    int status_bits;                        /* Status bits of the newest reply (docs/board-protocol.md). */
    int computed;                           /* 1: the controller ran and computed the members below. */
    int follows;                            /* 1: position_sent is the set point in force. 0: no set point is in
                                               force. */
    double position[3];                     /* Measured joint angles, rad. */
    double position_sent[3];                /* Joint angles of the set point in force, rad. The anchor of the spring
                                               moves toward them. */
    double tension[4];                      /* Measured tendon tensions, N. */
    double tension_sent[4];                 /* Commanded tendon tensions, N. */
    double torque[4];                       /* Commanded motor torques, N cm, sent in the next cycle. */
};

/*
 sun2xp_record - one cycle of the last two seconds of a finger

   finger   1 to 3
   cycle    a cycle from record->oldest to record->newest of an earlier call; 0: the newest cycle
   record   result; set record->size before the call

 A record is a part of what sun2xp_write_black_box writes into a file. Every cycle adds a record.
 Records older than two seconds are removed, several at a time. A faulted finger adds no records, so its
 records are the last ones before the fault.
 If hand.black_box is set and a finger recovers right after a fault, its new cycles cannot be read until
 the library has copied the records of the fault. This takes up to 50 ms.

 Returns 0, or a negative number with
   EPERM    forked child
   EFAULT   record is null
   ENODEV   no such hand
   EINVAL   size is too small; no such finger
   ENOENT   the cycle is no longer stored, or has not taken place yet

 Threads: any. Never waits for a servo.

 Example, which prints the newer half of the records:

     struct sun2xp_record record;
     unsigned long cycle, last;
     record.size = sizeof record;
     if (sun2xp_record(hand, 1, 0, &record) == 0) {
         last = record.newest;
         for (cycle = (record.oldest + last) / 2; cycle <= last; cycle++)
             if (sun2xp_record(hand, 1, cycle, &record) == 0)
                 printf("%f %f\n", record.time, record.tension[0]);
     }
 */
int sun2xp_record(sun2xp_hand *hand, int finger, unsigned long cycle, struct sun2xp_record *record);

/*
 sun2xp_write_black_box - write the last seconds of a finger into a file

   finger   1 to 3
   path     the file; an existing file is replaced

 The library stores the last two seconds of every finger: feedback, set points, motor commands, timing
 and state. For a faulted finger these are the last two seconds before the fault. docs/black-box.md
 describes the file, and `sun2xp replay path` recomputes its cycles. If hand.black_box is set, the
 library also writes such a file whenever a finger faults.

 The library writes a temporary file with a name that begins with ".sun2xp-" into the same folder, and
 renames it when it is complete and on the disk. So the folder must be writable, and a refused call leaves
 an old file unchanged. There is one exception: after the renaming, the library flushes the folder to the
 disk. If this flush fails, the call is refused although the new file is in its place.
 The call takes about 50 ms plus the time that the disk needs for some MB. The servos continue.

 Returns 0, or a negative number with
   EPERM    forked child
   EFAULT   path is null
   ENODEV   no such hand
   EINVAL   no such finger; path names something other than a regular file, such as a symbolic link,
            a device or a folder
   ENOENT, EACCES, ENOSPC ...  the file cannot be written

 Threads: any. If two calls write to the same path, the file of the last one remains.

 Example:

     sun2xp_write_black_box(hand, 1, "finger-1.jsonl");
 */
int sun2xp_write_black_box(sun2xp_hand *hand, int finger, const char *path);

/* These do not compile if the compiler lays out structs differently than the library. */
#ifdef __LP64__
typedef char sun2xp_error_size[sizeof(struct sun2xp_error) == 40 ? 1 : -1];
typedef char sun2xp_io_terms_size[sizeof(struct sun2xp_io_terms) == 112 ? 1 : -1];
typedef char sun2xp_io_sample_size[sizeof(struct sun2xp_io_sample) == 72 ? 1 : -1];
typedef char sun2xp_io_command_size[sizeof(struct sun2xp_io_command) == 64 ? 1 : -1];
typedef char sun2xp_io_size[sizeof(struct sun2xp_io) == 72 ? 1 : -1];
typedef char sun2xp_tip_size[sizeof(struct sun2xp_tip) == 208 ? 1 : -1];
typedef char sun2xp_set_point_size[sizeof(struct sun2xp_set_point) == 48 ? 1 : -1];
typedef char sun2xp_path_pose_size[sizeof(struct sun2xp_path_pose) == 56 ? 1 : -1];
typedef char sun2xp_joint_torques_size[sizeof(struct sun2xp_joint_torques) == 56 ? 1 : -1];
typedef char sun2xp_palm_pose_size[sizeof(struct sun2xp_palm_pose) == 200 ? 1 : -1];
typedef char sun2xp_limits_size[sizeof(struct sun2xp_limits) == 112 ? 1 : -1];
typedef char sun2xp_touch_size[sizeof(struct sun2xp_touch) == 40 ? 1 : -1];
typedef char sun2xp_object_size[sizeof(struct sun2xp_object) == 240 ? 1 : -1];
typedef char sun2xp_status_size[sizeof(struct sun2xp_status) == 120 ? 1 : -1];
typedef char sun2xp_timing_size[sizeof(struct sun2xp_timing) == 128 ? 1 : -1];
typedef char sun2xp_fault_size[sizeof(struct sun2xp_fault) == 48 ? 1 : -1];
typedef char sun2xp_event_size[sizeof(struct sun2xp_event) == 80 ? 1 : -1];
typedef char sun2xp_reflex_size[sizeof(struct sun2xp_reflex) == 168 ? 1 : -1];
typedef char sun2xp_record_size[sizeof(struct sun2xp_record) == 208 ? 1 : -1];
#endif

#ifdef __cplusplus
}
#endif

#if defined(__cplusplus) && defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

#if defined(__clang__) || defined(__GNUC__)
#pragma pack(pop)
#endif

#endif
