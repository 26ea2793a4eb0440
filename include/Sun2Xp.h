/* Sun2Xp.h - a three-finger tendon-driven hand as a set of springs

   GENERATED from src/capi/; do not edit. To renew it:

       SUN2XP_WRITE_HEADER=1 cargo test --test header

   This file is the manual of the C interface:

       1. Quick start             6. Threads, signals, fork, exit
       2. Return values, errno    7. Servo and real time
       3. Units, frames, order    8. Configuration
       4. float and double        9. The calls
       5. Planners of 1990       10. Faults


   1. QUICK START

   Example, planner.c:

       #include <stdio.h>
       #include <unistd.h>
       #include "Sun2Xp.h"

       int main(void)
       {
           double Pos[3] = {0.0, 0.5, 0.8};
           double Kx[3][3] = {{3, 0, 0}, {0, 3, 0}, {0, 0, 3}};

           if (OpenHand() != 0) {
               fprintf(stderr, "%s\n", HandError());
               return 1;
           }
           SendKx(1, Kx);
           SendPos(1, Pos);
           sleep(2);
           if (GetPos(1, Pos) == 0)
               printf("%.2f %.2f %.2f\n", Pos[0], Pos[1], Pos[2]);
           return CloseHand();
       }

   Example, how to compile and run it:

       cc planner.c -I include -L lib -lsun2xp -Wl,-rpath,lib
       ./a.out

   Angles are in rad, stiffness in N/cm. Each finger is a spring: it pulls its tip toward the pose
   sent last by SendPos, with the stiffness sent last by SendKx. Without a configuration file the
   program moves a simulated hand, and one line on standard error says so.


   2. RETURN VALUES, ERRNO

   Every call except HandError and FaultText returns an int: 0 if it succeeded, -1 if it was
   refused. NextEvent, WaitEvent, EventDescriptor and InstallReflex also return larger numbers. A
   refused call changes nothing, unless its entry says otherwise. errno gives the kind of the
   refusal. HandError() gives its cause and the remedy:

       EPERM      the process is a forked child (chapter 6)
       EFAULT     an argument is a null pointer
       ENODEV     no hand is open
       EBUSY      a hand is open already, or is being opened or closed; the finger is being
                  calibrated or recovered; 16 groups of a finger wait; the key cannot change while a
                  hand is open
       EINVAL     no such finger; NaN or infinity; an unusable configuration
       ERANGE     angles outside the joint limits; a tip out of reach; Kx stiffer than the bound;
                  damping outside its range
       EDOM       Kx not symmetric, or with a negative eigenvalue; a normal of length zero
       EIO        the finger is faulted: it has stopped by itself
       ETIMEDOUT  the time limit of a wait or of a calibration is over
       ENOTSUP    not for a finger on a real port
       ESHUTDOWN  the process is exiting, and the hand is closed (chapter 6)
       others     errno of the system, or the nearest: configuration file, port, enforced real time

   If several reasons apply, a call reports the one that its entry lists first. A call that succeeds
   changes neither errno nor the text of HandError().

   Arrays, structs and texts are read and written only during the call. An output is written only if
   the call returns 0, and by NextEvent and WaitEvent only if they return 1.

   Planners of 1990 ignore return values. For them the first refusal of each kind in a process also
   prints one line on standard error, unless hand.print_refusals is false.


   3. UNITS, FRAMES, ORDER

   Angles are in rad, lengths in cm, forces in N, stiffness in N/cm. The fingers are 1, 2 and 3; 3
   is the thumb. The joints are 0, 1 and 2: 0 turns the finger sideways, 1 and 2 bend it.

   The frame of a finger has its origin at the finger's base. With link lengths
   l0 = 3.556, l1 = 5.080, l2 = 4.000 cm (configurable) the tip is at

       x = (l0 + l1 cos(j1) + l2 cos(j1 + j2)) sin(j0)
       y = -l1 sin(j1) - l2 sin(j1 + j2)
       z = (l0 + l1 cos(j1) + l2 cos(j1 + j2)) cos(j0)

   At angles 0, 0, 0 the finger is straight along z. Bending moves the tip toward -y. Kx, forces and
   displacements are in this frame. Matrices are in row-major order, as in C: Kx[row][column].


   4. FLOAT AND DOUBLE

   SendPos, SendKx and GetPos take arrays of float and arrays of double. The compiler chooses by the
   type of the argument (Pos[3], Kx[3][3] or Kx[9], const or not), in C with macros and in C++ with
   templates. Other types do not compile: cast a void * pointer to the type of its elements. NULL
   and 0 compile, and are refused with EFAULT. C arrays of variable length compile, but their
   lengths are not checked.

   The C macros are function-like, so they do not work for a planner that declares the functions
   itself or takes their addresses. Compile such a planner with

       -DSUN2XP_REAL=float     or      -DSUN2XP_REAL=double

   for the element type of all its arrays. SendPos, SendKx and GetPos are then plain functions for
   that type; for double they are renamed to SendPosD, SendKxD and GetPosD. The planner's
   declarations may be int SendPos(); or those below. If they differ from those below, add
   -DSUN2XP_H, which leaves out this header.

   In the library, the symbols SendPos, SendKx and GetPos take float, and those ending in D take
   double. Compilers without _Generic (gcc before 4.9) choose by the size of an element: they treat
   an array of int as one of float, and NULL needs a cast.


   5. PLANNERS OF 1990

       #include "Sun2Xp.c"        works, also in several files of a program: it includes this header
       K&R source                 gcc -std=gnu89
       no include at all          the plain symbols take float; for double compile with
                                  -DSendPos=SendPosD -DSendKx=SendKxD -DGetPos=GetPosD
       return values ignored      see the line on standard error (chapter 2)
       own functions named        #define SUN2XP_FIVE_CALLS before the include: the header then
       GetTip, StopHand ...       declares only OpenHand, SendPos, SendKx, GetPos, CloseHand and
                                  HandError, and SendPosD, SendKxD and GetPosD for double. The
                                  shared library never calls the planner's functions instead of its
                                  own. To link the static library, name the planner's files first
                                  and add -Wl,--allow-multiple-definition

   Macros: with gcc and clang this header saves the planner's macros and restores them at its end.
   So a planner may have macros named i, K or Pos, macros of X11 such as Status, and macros named
   like C keywords, such as const, volatile, int or float. The exceptions are

       SendPos, SendKx, GetPos, SendPosD, SendKxD, GetPosD
       names that begin with EVENT_, FAULT_, FINGER_, TIMING_, WHEN_, THEN_, SUN2XP_ or Sun2Xp
       _Pragma, and names that the compiler defines itself
       _Generic, default and sizeof where a C file calls SendPos, SendKx or GetPos

   A planner must not poison a name that this header uses (#pragma GCC poison). With other
   compilers, no macro of the planner may have the name of a C keyword or of a struct, member or
   call of this header.

   Packing: with gcc and clang the structs of this header have the library's layout even after
   #pragma pack. If a 64-bit compiler gives them another layout, as gcc -fpack-struct does, the
   header does not compile.


   6. THREADS, SIGNALS, FORK, EXIT

   Threads: any thread may make any call, also while other threads make calls. A servo never waits
   for a call. A call waits for a servo only if its entry says so. If two threads command one
   finger, the later call wins; each command takes effect as a whole.

   Signals: the servo threads block all signals, so only the planner's own threads run its signal
   handlers, also for alarms. A signal handler may call StopHand, and no other call. C does not
   guarantee that exit works in a signal handler. If a handler calls exit nevertheless, the library
   closes the hand. If the signal interrupted OpenHand or CloseHand, the process may end before the
   hand is closed. Then the boards' watchdogs end the motion.

   The planner's arrays, structs and texts may lie in pages that its own handler of SIGSEGV or
   SIGBUS makes accessible when a call first accesses them.

   Standard error: lines of the library are lost if standard error is a pipe without a reader, or a
   file that may not grow. The planner gets no SIGPIPE and no SIGXFSZ for these lines. A call that
   prints a line waits until the line is written. So a full pipe or a stopped terminal (Control-S)
   delays OpenHand and the first refusal of each kind, but no servo.

   Stack: a call needs up to 16 KiB of its thread's stack. The stack of each thread of the library
   contains a copy of the planner's thread-local data (__thread). So large thread-local data enlarge
   these stacks and, unless hand.real_time is "ignore", the locked memory of each servo.

   Sandbox: install a sandbox (seccomp) before OpenHand. If it forbids a system call that threads,
   waits, ports or pseudo-terminals need, OpenHand is refused with the errno of the sandbox.

   Slow calls: OpenHand, CloseHand, RecoverHand, ZeroFinger, IdentifyFinger, AdjustFinger,
   SetGravity, WriteBlackBox, WaitFingers, OnEvent, EventDescriptor and WaitEvent (while there is no
   event) run in a thread of the library, and the planner's thread waits for it. A signal handler may
   jump out of that wait (siglongjmp). The call then continues to its end; until then OpenHand is
   refused with EBUSY, and CloseHand waits. A WaitEvent that is left takes no event.

   Undefined behaviour: the behaviour is undefined if a signal handler jumps out of any other call
   (longjmp, siglongjmp). The same holds if a handler that interrupted a call calls pthread_exit or,
   in C++, lets an exception escape.

   Memory: OpenHand allocates the memory for the servos, for CloseHand and for all calls that are not
   slow, except SendPath. These calls work even if malloc later returns NULL. OpenHand (12 MiB),
   RecoverHand, ZeroFinger, IdentifyFinger, AdjustFinger, SetGravity and WriteBlackBox (4 MiB),
   SendPath (1 MiB), WaitFingers, OnEvent, EventDescriptor and WaitEvent (64 KiB) are refused with
   ENOMEM if that much memory is not free. If memory runs out while one of them runs, the process is
   aborted, and the boards' watchdogs end the motion. If less than 4 MiB are free when a finger
   faults, the fault is reported but no black box is written, and a line on standard error says so. If
   the library was loaded with dlopen, the first call of a thread needs memory for its thread-local
   data. If there is none, the C library aborts the process.

   Cancellation: pthread_cancel does not interrupt a call. It takes effect at the planner's next
   cancellation point or, with asynchronous cancellation, when the call returns.

   Floating point: the library computes in the default environment, in its threads and in every
   call. A call leaves the planner's rounding mode, traps, treatment of denormals and exception
   flags as they were.

   Fork: a child process has no servo threads. Once a process has called OpenHand, every call in a
   child forked from it is refused with EPERM, except HandError, FaultText and StopHand; the parent
   is not affected. This applies to children of fork, of _Fork and of the system calls fork and
   clone, and already inside handlers of pthread_atfork. Before Linux 4.14 it applies only to
   children of fork, and only after these handlers have run. A child that shares the memory of its
   parent (vfork) may only call exec. A child that calls exec starts afresh.

   CloseHand releases the ports even if forked children are alive. If the planner ends without
   CloseHand, its ports stay locked until those children have ended too.

   Descriptors: a daemon must detach before it calls OpenHand. The library's descriptors close at
   exec. Their numbers are 512 or more if the limit (ulimit -n) permits it, so a planner may close
   all descriptors up to 255 and keep its hand. A planner that closes all descriptors loses its
   hand: the fingers fault with FAULT_PORT_CLOSED or FAULT_PORT_VANISHED. The library does not touch
   files that the planner then opens under these numbers. CloseHand and OpenHand start the hand
   again.

   Exit: when a planner exits with a hand open, an exit handler of the library brings the fingers to
   their end state, as CloseHand does. The first OpenHand registers that handler (atexit). Exit
   handlers that the planner registers later run before it and find the hand open. Those registered
   earlier run after it and find the hand closed: calls that only read still work, calls that would
   open or move a hand are refused with ESHUTDOWN, and CloseHand returns 0.

   A planner that is killed or calls _exit leaves the motors to the boards, which receive no more
   commands and enter the configured end state. If the last thread of a process ends by pthread_exit
   with a hand open, the library ends the process within some seconds, as exit (0) does. dlclose
   does not unload the library, and the hand stays open.


   7. SERVO AND REAL TIME

   By default each finger has its own servo thread, which runs 1000 times a second under SCHED_FIFO,
   with locked memory and on the configured core. If the system does not permit that, OpenHand
   follows hand.real_time:

       "try"      OpenHand continues without it; one line on standard error and GetStatus report
                  that. Everything works, but with the jitter of an ordinary process
       "enforce"  OpenHand is refused, and HandError says what to change
       "ignore"   OpenHand does not try to get real time

   RLIMIT_RTTIME (ulimit -R) limits how long a thread under SCHED_FIFO may run without waiting. The
   system ends a process that exceeds it, by SIGXCPU at the soft limit and by SIGKILL at the hard
   limit. A servo waits in every cycle, but the system counts the time in ticks of up to 10 ms. Set
   the limit to 100000 (microseconds) or more, or to unlimited, or set hand.real_time to "ignore".

   sun2xp doctor examines a machine and says what to change. GetTiming reports where the time of a
   cycle goes.


   8. CONFIGURATION

   OpenHand uses the first of these:

       1. the file that the environment variable SUN2XP_CONFIG names; it must exist. An empty
          SUN2XP_CONFIG counts as not set
       2. sun2xp.toml in the working directory
       3. sun2xp/sun2xp.toml in $XDG_CONFIG_HOME, or ~/.config
       4. sun2xp/sun2xp.toml in the folders of $XDG_CONFIG_DIRS, or /etc/xdg
       5. no file: the simulated hand, announced in one line on standard error

   The file must be a regular file of at most 1 MiB. A finger without a port in the file is
   simulated, and announced too; with port = "simulated" it is not announced.

   A program that is setuid or setgid, or whose file has capabilities, does not trust its
   environment and working directory, which belong to its caller. It reads only
   /etc/xdg/sun2xp/sun2xp.toml; if SUN2XP_CONFIG is set, OpenHand fails with EACCES.

   The file is TOML: [hand], [finger] for all fingers, [finger.1] to [finger.3] for one. Every key
   has a default. An unknown key is refused, with file, line and reason.

   Example, sun2xp.toml:

       [hand]
       rate = 1000.0
       [finger.1]
       port = "/dev/ttyUSB0"


   9. THE CALLS: below, each with its manual

   A struct that a call fills begins with Size. Set it to the sizeof of the struct before the call.
   Later versions of the library add members at the end; a call never writes more than Size bytes.

   The examples are statements of a function that has opened the hand, in a file that includes
   errno.h, poll.h, signal.h, stdio.h, stdlib.h and unistd.h.


   10. FAULTS

   Every fault has a number that never changes (FAULT_..., below). FaultText gives its text, likely
   cause and remedy. A fault stops the finger: its motors enter the configured end state, and calls
   for it are refused with EIO until RecoverHand, or CloseHand and OpenHand. HandError gives the
   reason. A warning does not stop the finger. It lasts until one second after its cause was last
   detected. GetFault reports both. Some faults make OpenHand fail; HandError gives their numbers.
   docs/faults.md lists all faults, and describes how each is detected and how long that takes. */

#ifndef SUN2XP_H
#define SUN2XP_H

#ifdef SUN2XP_REAL
/* The value of SUN2XP_REAL as a number: 1 for float, 2 for double, 0 for anything else. */
#define SUN2XP_REAL_IS_float 1
#define SUN2XP_REAL_IS_double 2
#define SUN2XP_PASTE_NOW(Left, Right) Left##Right
#define SUN2XP_PASTE(Left, Right) SUN2XP_PASTE_NOW(Left, Right)
#if SUN2XP_PASTE(SUN2XP_REAL_IS_, SUN2XP_REAL) == 2
#define SUN2XP_REAL_DOUBLE
#elif SUN2XP_PASTE(SUN2XP_REAL_IS_, SUN2XP_REAL) != 1
#error "SUN2XP_REAL must be float or double: compile with -DSUN2XP_REAL=float or -DSUN2XP_REAL=double"
#endif
#endif

/* Macros of the planner whose names are used below are saved here and restored at the end. */
#if defined(__clang__) || (defined(__GNUC__) && (__GNUC__ > 4 || (__GNUC__ == 4 && __GNUC_MINOR__ >= 6)))
#define SUN2XP_SETS_MACROS_ASIDE
#endif

#ifdef SUN2XP_SETS_MACROS_ASIDE
_Pragma("push_macro(\"AdjustFinger\")") _Pragma("push_macro(\"Answered\")") _Pragma("push_macro(\"Base\")")
_Pragma("push_macro(\"Bound\")") _Pragma("push_macro(\"Calibration\")") _Pragma("push_macro(\"CloseHand\")")
_Pragma("push_macro(\"Commanded\")") _Pragma("push_macro(\"Computed\")") _Pragma("push_macro(\"Condition\")")
_Pragma("push_macro(\"Contact\")") _Pragma("push_macro(\"CorruptReplies\")") _Pragma("push_macro(\"Count\")")
_Pragma("push_macro(\"Cycle\")") _Pragma("push_macro(\"Cycles\")") _Pragma("push_macro(\"DamagedFrames\")")
_Pragma("push_macro(\"Damping\")") _Pragma("push_macro(\"DuplicateReplies\")") _Pragma("push_macro(\"Event\")")
_Pragma("push_macro(\"EventDescriptor\")") _Pragma("push_macro(\"Fault\")") _Pragma("push_macro(\"FaultText\")")
_Pragma("push_macro(\"Felt\")") _Pragma("push_macro(\"FindPos\")") _Pragma("push_macro(\"FindTip\")")
_Pragma("push_macro(\"Finger\")") _Pragma("push_macro(\"FingerCommand\")") _Pragma("push_macro(\"FingerRecord\")")
_Pragma("push_macro(\"FingerStatus\")") _Pragma("push_macro(\"FingerTiming\")") _Pragma("push_macro(\"FingerTip\")")
_Pragma("push_macro(\"FingerTouch\")") _Pragma("push_macro(\"Follows\")") _Pragma("push_macro(\"Force\")")
_Pragma("push_macro(\"ForeignFrames\")") _Pragma("push_macro(\"GetFault\")") _Pragma("push_macro(\"GetJacobian\")")
_Pragma("push_macro(\"GetJointTorques\")") _Pragma("push_macro(\"GetObject\")") _Pragma("push_macro(\"GetPalmPose\")")
_Pragma("push_macro(\"GetRecord\")") _Pragma("push_macro(\"GetStatus\")") _Pragma("push_macro(\"GetTiming\")")
_Pragma("push_macro(\"GetTip\")") _Pragma("push_macro(\"GetTouch\")") _Pragma("push_macro(\"HandError\")")
_Pragma("push_macro(\"IdentifyFinger\")") _Pragma("push_macro(\"Inhibition\")") _Pragma("push_macro(\"InstallReflex\")")
_Pragma("push_macro(\"IsTip\")") _Pragma("push_macro(\"Joint\")") _Pragma("push_macro(\"JointTorques\")")
_Pragma("push_macro(\"Kind\")") _Pragma("push_macro(\"Kx\")") _Pragma("push_macro(\"LateReplies\")")
_Pragma("push_macro(\"Lost\")") _Pragma("push_macro(\"LostEvents\")") _Pragma("push_macro(\"LostReplies\")")
_Pragma("push_macro(\"Maximum\")") _Pragma("push_macro(\"Measured\")") _Pragma("push_macro(\"MeasuredRate\")")
_Pragma("push_macro(\"Median\")") _Pragma("push_macro(\"MemoryLocked\")") _Pragma("push_macro(\"Minimum\")")
_Pragma("push_macro(\"Most\")") _Pragma("push_macro(\"Newest\")") _Pragma("push_macro(\"NextEvent\")")
_Pragma("push_macro(\"Number\")") _Pragma("push_macro(\"ObjectState\")") _Pragma("push_macro(\"Oldest\")")
_Pragma("push_macro(\"OnCore\")") _Pragma("push_macro(\"OnEvent\")") _Pragma("push_macro(\"OpenHand\")")
_Pragma("push_macro(\"Overruns\")") _Pragma("push_macro(\"P99\")") _Pragma("push_macro(\"P999\")")
_Pragma("push_macro(\"PalmPose\")") _Pragma("push_macro(\"Part\")") _Pragma("push_macro(\"PathPose\")")
_Pragma("push_macro(\"Place\")") _Pragma("push_macro(\"Pos\")") _Pragma("push_macro(\"PosSent\")")
_Pragma("push_macro(\"Position\")") _Pragma("push_macro(\"Pressed\")") _Pragma("push_macro(\"Priority\")")
_Pragma("push_macro(\"PushFinger\")") _Pragma("push_macro(\"Rate\")") _Pragma("push_macro(\"Reaction\")")
_Pragma("push_macro(\"Realtime\")") _Pragma("push_macro(\"RecoverHand\")") _Pragma("push_macro(\"Reflex\")")
_Pragma("push_macro(\"Refractory\")") _Pragma("push_macro(\"RemoveReflex\")") _Pragma("push_macro(\"Reserved\")")
_Pragma("push_macro(\"ResetTiming\")") _Pragma("push_macro(\"Rotation\")") _Pragma("push_macro(\"SendContact\")")
_Pragma("push_macro(\"SendDamping\")") _Pragma("push_macro(\"SendGroup\")")
_Pragma("push_macro(\"SendJointStiffness\")") _Pragma("push_macro(\"SendJointTorque\")")
_Pragma("push_macro(\"SendPath\")") _Pragma("push_macro(\"SendPosFor\")") _Pragma("push_macro(\"SendTip\")")
_Pragma("push_macro(\"SetGravity\")") _Pragma("push_macro(\"Size\")") _Pragma("push_macro(\"SkippedPeriods\")")
_Pragma("push_macro(\"Slide\")") _Pragma("push_macro(\"Spin\")") _Pragma("push_macro(\"Stage\")")
_Pragma("push_macro(\"State\")") _Pragma("push_macro(\"StatusBits\")") _Pragma("push_macro(\"Stiffness\")")
_Pragma("push_macro(\"StiffnessScale\")") _Pragma("push_macro(\"StopFinger\")") _Pragma("push_macro(\"StopHand\")")
_Pragma("push_macro(\"TareTouch\")") _Pragma("push_macro(\"Tension\")") _Pragma("push_macro(\"TensionSent\")")
_Pragma("push_macro(\"Tensions\")") _Pragma("push_macro(\"Time\")") _Pragma("push_macro(\"Tip\")")
_Pragma("push_macro(\"TipRotation\")") _Pragma("push_macro(\"Torque\")") _Pragma("push_macro(\"TorqueScale\")")
_Pragma("push_macro(\"Touching\")") _Pragma("push_macro(\"Unused\")") _Pragma("push_macro(\"Valid\")")
_Pragma("push_macro(\"Value\")") _Pragma("push_macro(\"Values\")") _Pragma("push_macro(\"Velocity\")")
_Pragma("push_macro(\"WaitEvent\")") _Pragma("push_macro(\"WaitFingers\")") _Pragma("push_macro(\"WakeUp99\")")
_Pragma("push_macro(\"WakeUpMaximum\")") _Pragma("push_macro(\"WakeUpMedian\")") _Pragma("push_macro(\"Warning\")")
_Pragma("push_macro(\"WarningPart\")") _Pragma("push_macro(\"WarningValue\")") _Pragma("push_macro(\"Warnings\")")
_Pragma("push_macro(\"WriteBlackBox\")") _Pragma("push_macro(\"ZeroFinger\")") _Pragma("push_macro(\"char\")")
_Pragma("push_macro(\"class\")") _Pragma("push_macro(\"const\")") _Pragma("push_macro(\"double\")")
_Pragma("push_macro(\"extern\")") _Pragma("push_macro(\"float\")") _Pragma("push_macro(\"inline\")")
_Pragma("push_macro(\"int\")") _Pragma("push_macro(\"long\")") _Pragma("push_macro(\"reinterpret_cast\")")
_Pragma("push_macro(\"return\")") _Pragma("push_macro(\"sizeof\")") _Pragma("push_macro(\"struct\")")
_Pragma("push_macro(\"template\")") _Pragma("push_macro(\"typedef\")") _Pragma("push_macro(\"unsigned\")")
_Pragma("push_macro(\"void\")") _Pragma("push_macro(\"volatile\")")
#undef AdjustFinger
#undef Answered
#undef Base
#undef Bound
#undef Calibration
#undef CloseHand
#undef Commanded
#undef Computed
#undef Condition
#undef Contact
#undef CorruptReplies
#undef Count
#undef Cycle
#undef Cycles
#undef DamagedFrames
#undef Damping
#undef DuplicateReplies
#undef Event
#undef EventDescriptor
#undef Fault
#undef FaultText
#undef Felt
#undef FindPos
#undef FindTip
#undef Finger
#undef FingerCommand
#undef FingerRecord
#undef FingerStatus
#undef FingerTiming
#undef FingerTip
#undef FingerTouch
#undef Follows
#undef Force
#undef ForeignFrames
#undef GetFault
#undef GetJacobian
#undef GetJointTorques
#undef GetObject
#undef GetPalmPose
#undef GetRecord
#undef GetStatus
#undef GetTiming
#undef GetTip
#undef GetTouch
#undef HandError
#undef IdentifyFinger
#undef Inhibition
#undef InstallReflex
#undef IsTip
#undef Joint
#undef JointTorques
#undef Kind
#undef Kx
#undef LateReplies
#undef Lost
#undef LostEvents
#undef LostReplies
#undef Maximum
#undef Measured
#undef MeasuredRate
#undef Median
#undef MemoryLocked
#undef Minimum
#undef Most
#undef Newest
#undef NextEvent
#undef Number
#undef ObjectState
#undef Oldest
#undef OnCore
#undef OnEvent
#undef OpenHand
#undef Overruns
#undef P99
#undef P999
#undef PalmPose
#undef Part
#undef PathPose
#undef Place
#undef Pos
#undef PosSent
#undef Position
#undef Pressed
#undef Priority
#undef PushFinger
#undef Rate
#undef Reaction
#undef Realtime
#undef RecoverHand
#undef Reflex
#undef Refractory
#undef RemoveReflex
#undef Reserved
#undef ResetTiming
#undef Rotation
#undef SendContact
#undef SendDamping
#undef SendGroup
#undef SendJointStiffness
#undef SendJointTorque
#undef SendPath
#undef SendPosFor
#undef SendTip
#undef SetGravity
#undef Size
#undef SkippedPeriods
#undef Slide
#undef Spin
#undef Stage
#undef State
#undef StatusBits
#undef Stiffness
#undef StiffnessScale
#undef StopFinger
#undef StopHand
#undef TareTouch
#undef Tension
#undef TensionSent
#undef Tensions
#undef Time
#undef Tip
#undef TipRotation
#undef Torque
#undef TorqueScale
#undef Touching
#undef Unused
#undef Valid
#undef Value
#undef Values
#undef Velocity
#undef WaitEvent
#undef WaitFingers
#undef WakeUp99
#undef WakeUpMaximum
#undef WakeUpMedian
#undef Warning
#undef WarningPart
#undef WarningValue
#undef Warnings
#undef WriteBlackBox
#undef ZeroFinger
#undef char
#undef class
#undef const
#undef double
#undef extern
#undef float
#undef inline
#undef int
#undef long
#undef reinterpret_cast
#undef return
#undef sizeof
#undef struct
#undef template
#undef typedef
#undef unsigned
#undef void
#undef volatile
#endif

#if defined(__clang__) || defined(__GNUC__)
#pragma pack(push, 16)
#endif

#ifdef __cplusplus
extern "C" {
#endif

/*
 OpenHand - start the hand

     int OpenHand(void);

 Reads the configuration (chapter 8), opens the ports, starts the servos and brings the tendons
 under tension. Returns when every finger has answered and holds its present pose at the configured
 initial stiffness. From then on GetPos is valid, and nothing moves until SendPos. Takes at most
 about a second for the simulated hand.

 Returns 0, or -1 with
   EPERM    forked child
   EBUSY    a hand is open and stays open, or another thread is opening or closing one
   ENOENT, EACCES ...  the configuration file cannot be read; errno of the system
   EINVAL   the configuration is unusable; HandError names file, line and reason
   ENOENT, EACCES, EBUSY ...  a port cannot be opened; errno of the system
   ETIMEDOUT and other errnos of a link: a board does not answer, or the device is not a board
   EIO      a finger does not come under tension in time, or faults before it does
   EPERM, ENOMEM, EINVAL ...  hand.real_time is "enforce", and SCHED_FIFO, locked memory or the
            configured core is not available; HandError says what to change

 Threads: any; one hand per process.

 Example:

     if (OpenHand() != 0) {
         fprintf(stderr, "%s\n", HandError());
         exit(1);
     }
 */
int OpenHand(void);

/*
 CloseHand - stop the hand

     int CloseHand(void);

 Brings every finger to the configured end state and stops the servos. With hand.end_state =
 "release" the torque ramps to zero. With "hold" the board keeps the last torque, up to
 hand.hold_torque_limit, for hand.hold_time_ms, also after this call has returned. If no hand is
 open, the call does nothing and returns 0. OpenHand may be called again afterwards. At exit the
 library closes a hand that is still open.

 Returns 0, or -1 with
   EPERM    forked child
   EBUSY    in a callback of OnEvent: another thread is opening or closing the hand

 Threads: any. Waits for an OpenHand or CloseHand of another thread, then closes. Waits until the
 callback of OnEvent has returned, except in this callback.
 */
int CloseHand(void);

/*
 SendPos - send desired joint angles to a finger

     int SendPos(int i, const float *Pos);      also takes const double *Pos (chapter 4)

   i     finger, 1 to 3
   Pos   Pos[3]: desired angles of joints 0, 1, 2, rad (chapter 3)

 All three angles take effect together. From the next cycle on the anchor of the fingertip's spring
 moves to Pos, along a straight line in joint angles and at a bounded speed. The stiffness is the one
 sent last. When the anchor is at Pos, Tip is the position that the fingertip has there, and p its
 present position, the force is Kx (Tip - p) at any distance. With controller.law = "report" the
 finger follows the law of the report, which holds for small distances. The call does not wait until
 the finger arrives; GetPos reads where it is. The limits are the configured joint limits, by default
 -1.0472 to 1.0472 for joint 0, -0.5236 to 1.7453 for joint 1 and 0.0873 to 2.0944 for joint 2.

 Returns 0, or -1 with
   EPERM    forked child
   EFAULT   Pos is null
   ENODEV   no hand is open
   EINVAL   no such finger; an angle is NaN or infinite
   ERANGE   an angle is outside the joint limits (hand.out_of_range = "clamp" clamps it instead)
   EIO      the finger is faulted

 Threads: any. Never waits for a servo. Takes about 100 ns.

 Example:

     float Pos[3] = {0.0, 0.5, 0.8};
     SendPos(1, Pos);
 */
int SendPos(int, const float *);

/*
 SendPosD - SendPos for an array of double

     int SendPosD(int i, const double *Pos);
 */
int SendPosD(int, const double *);

/*
 SendKx - set the stiffness of a fingertip

     int SendKx(int i, const float *Kx);        also takes const double *Kx (chapter 4)

   i     finger, 1 to 3
   Kx    Kx[3][3] or Kx[9], row by row: entry [row][column] is the force along axis row (x, y, z of
         the finger's frame, chapter 3) for a displacement of 1 cm along axis column, N/cm

 All entries begin to change in the next cycle, without a jump in torque: 95 % of the change has
 taken effect after 50 ms. Kx must be symmetric; two mirrored entries that differ by up to 1e-3 of
 the largest entry are averaged. No eigenvalue may be below -1e-3 times the largest one. Kx may be
 singular or zero: along directions without stiffness the finger is limp but still damped. The
 largest eigenvalue may be at most the configured bound, by default 6 N/cm at 1000 Hz and above, and
 5 N/cm below.

 Returns 0, or -1 with
   EPERM    forked child
   EFAULT   Kx is null
   ENODEV   no hand is open
   EINVAL   no such finger; an entry is NaN or infinite
   EDOM     Kx is not symmetric, or has a negative eigenvalue
   ERANGE   Kx is stiffer than the bound (hand.out_of_range = "clamp" clamps it instead)
   EIO      the finger is faulted
   ERANGE   Kx is too stiff for the ratio of SendDamping ("clamp" clamps the ratio instead)

 Threads: any. Never waits for a servo. Takes about 1 us.

 Example, softer along z:

     double Kx[3][3] = {{3, 0, 0}, {0, 3, 0}, {0, 0, 1}};
     SendKx(1, Kx);
 */
int SendKx(int, const float *);

/*
 SendKxD - SendKx for an array of double

     int SendKxD(int i, const double *Kx);
 */
int SendKxD(int, const double *);

/*
 GetPos - read the joint angles of a finger

     int GetPos(int i, float *Pos);             also takes double *Pos (chapter 4)

   i     finger, 1 to 3
   Pos   Pos[3]: measured angles of joints 0, 1, 2, rad, from the last cycle of the servo

 While the servo thread does not run, the angles stay those of its last cycle, and SkippedPeriods of
 GetStatus grows.

 Returns 0, or -1 with
   EPERM    forked child
   EFAULT   Pos is null
   ENODEV   no hand is open
   EINVAL   no such finger
   EIO      the finger is faulted

 Threads: any. Never waits for a servo. Takes about 100 ns.

 Example:

     double Pos[3];
     if (GetPos(2, Pos) == 0)
         printf("%g %g %g\n", Pos[0], Pos[1], Pos[2]);
 */
int GetPos(int, float *);

/*
 GetPosD - GetPos for an array of double

     int GetPosD(int i, double *Pos);
 */
int GetPosD(int, double *);

/*
 HandError - why a call was refused, and the remedy

     const char *HandError(void);

 Returns the text of the calling thread's last refused call, or an empty string if no call was
 refused. A call that succeeds does not change the text, as it does not change errno. So read the
 text only after a call has returned -1. The pointer is never null. Do not free the text: it belongs
 to the library, and is valid until the next refused call of the same thread.

 Threads: any; each has its own text. Works in a forked child too.
 */
const char *HandError(void);


#ifndef SUN2XP_FIVE_CALLS

/* The faults (chapter 10). Numbers never change. */
#define FAULT_SLACK_TENDON            1 /* slack tendon */
#define FAULT_BROKEN_TENDON           2 /* broken tendon */
#define FAULT_OVER_TENSION            3 /* over-tension */
#define FAULT_GAUGE_STUCK             4 /* gauge stuck */
#define FAULT_GAUGE_OUT_OF_RANGE      5 /* gauge out of range */
#define FAULT_GAUGE_DISAGREES         6 /* gauge against encoders */
#define FAULT_ENCODER_JUMP            7 /* encoder jump */
#define FAULT_STALLED_MOTOR           8 /* stalled motor */
#define FAULT_OVERHEATED_MOTOR        9 /* over-heated motor */
#define FAULT_JOINT_AT_STOP          10 /* joint at its stop */
#define FAULT_IMPOSSIBLE_POSE        11 /* impossible pose */
#define FAULT_SLACK_IN_MOTION        12 /* slack in motion */
#define FAULT_LOST_REPLIES           13 /* lost replies */
#define FAULT_DAMAGED_REPLIES        14 /* damaged replies */
#define FAULT_LINE_NOISE             15 /* noise on the line */
#define FAULT_WATCHDOG               16 /* watchdog */
#define FAULT_BOARD_STOPPED          17 /* board stopped */
#define FAULT_EMERGENCY_STOP_INPUT   18 /* emergency stop, input */
#define FAULT_EMERGENCY_STOP_CALL    19 /* emergency stop, call */
#define FAULT_SUPPLY_FAULT           20 /* motor supply */
#define FAULT_DRIVER_FAULT           21 /* motor driver */
#define FAULT_SENSOR_FAULT           22 /* sensor, by the board */
#define FAULT_BOARD_RESET            23 /* board reset */
#define FAULT_COMMAND_REFUSED        24 /* command refused */
#define FAULT_PORT_VANISHED          25 /* port vanished */
#define FAULT_PORT_FAILED            26 /* port failed */
#define FAULT_PORT_MISSING           27 /* port missing */
#define FAULT_PORT_BUSY              28 /* port busy */
#define FAULT_PORT_PERMISSION        29 /* port forbidden */
#define FAULT_PORT_UNUSABLE          30 /* port unusable */
#define FAULT_BOARD_SILENT           31 /* board silent */
#define FAULT_UNINTELLIGIBLE         32 /* no protocol */
#define FAULT_UNANSWERED             33 /* finger silent */
#define FAULT_WRONG_VERSION          34 /* wrong protocol version */
#define FAULT_WRONG_FINGER           35 /* wrong finger */
#define FAULT_UNSUITABLE_BOARD       36 /* wrong board */
#define FAULT_IDENTITY_CHANGED       37 /* identity changed */
#define FAULT_ZERO_LOST              38 /* zero lost */
#define FAULT_OVERRUN                39 /* overrun */
#define FAULT_REALTIME_REFUSED       40 /* no real time */
#define FAULT_SERVO_PANIC            41 /* servo failed */
#define FAULT_CURRENT_LIMIT          42 /* current limit */
#define FAULT_TORQUE_NOT_ADMITTED    43 /* torque not admitted */
#define FAULT_CALIBRATION_FAILED     44 /* calibration failed */
#define FAULT_WARM_MOTOR             45 /* warm motor */
#define FAULT_COMPANION              46 /* fault of another finger */
#define FAULT_PORT_CLOSED            47 /* port closed */
#define FAULT_OPENING_TIMED_OUT      48 /* opening timed out */
#define FAULT_SAME_NUMBER            49 /* same number */
#define FAULT_STOP_CALL              50 /* stop of the finger, call */
#define FAULT_SET_POINT_EXPIRED      51 /* set point expired */
#define FAULT_REFLEX_STOP            52 /* stopped by a reflex */

/* The kinds of events (docs/events.md). Numbers never change. */
#define EVENT_TOUCH_MADE              1 /* touch made */
#define EVENT_TOUCH_LOST              2 /* touch lost */
#define EVENT_TOUCH_SLIP              3 /* touch slips */
#define EVENT_TOUCH_PRESSURE          4 /* touch pressure */
#define EVENT_CONTACT                 5 /* contact */
#define EVENT_CONTACT_LOST            6 /* contact lost */
#define EVENT_SLIP                    7 /* slip */
#define EVENT_TENSION_BOUND           8 /* tension bound */
#define EVENT_FORCE_BOUND             9 /* force bound */
#define EVENT_JOINT_AT_LIMIT         10 /* joint at limit */
#define EVENT_ARRIVED                11 /* arrived */
#define EVENT_SETTLED                12 /* settled */
#define EVENT_FAULT                  13 /* fault */
#define EVENT_WARNING                14 /* warning */
#define EVENT_REFLEX_FIRED           15 /* reflex fired */
#define EVENT_PATH_ENDED             16 /* path ended */
#define EVENT_EXPIRED                17 /* set point expired */
#define EVENT_TOUCH_INVALID          18 /* touch invalid */

/* State of a finger (FingerStatus.State, FingerRecord.State) */
#define FINGER_RUNNING 1            /* The fingertip is the spring that the planner has commanded. */
#define FINGER_FAULTED 2            /* The finger has stopped because of a fault. Its motors are in the configured
                                       end state. Calls for the finger are refused with EIO until RecoverHand, or
                                       CloseHand and OpenHand. */
#define FINGER_LIMP 3               /* The motors are off after a refused calibration. Set points have no effect. The
                                       finger becomes a spring again after another calibration, or after CloseHand
                                       and OpenHand. */
#define FINGER_CALIBRATING 4        /* ZeroFinger or IdentifyFinger moves the finger. Set points have no effect. */
#define FINGER_TENSIONING 5         /* RecoverHand or the end of a calibration brings the tendons under tension. Set
                                       points have no effect. */
#define FINGER_CLOSED 6             /* The process exits without CloseHand, and the finger goes to its configured end
                                       state or is in it. Only exit handlers and remaining threads see this state. */

/* Stage of a cycle (GetTiming, FingerTiming.Stage) */
#define TIMING_WAKE_UP 0            /* From the scheduled start of a cycle to the thread's first instruction. */
#define TIMING_WRITE 1              /* Passing the commands of the port to the system. */
#define TIMING_WIRE 2               /* From the end of TIMING_WRITE until the reply can be read: the line in both
                                       directions, and the board. */
#define TIMING_READ 3               /* Reading the reply. */
#define TIMING_DECODE 4             /* Decoding the bytes to the finger's reply, including all checks. */
#define TIMING_COMPUTE 5            /* Computing the command and the report. */
#define TIMING_CYCLE 6              /* From the scheduled start of a cycle to the end of its computation. */
#define TIMING_AGE 7                /* Age of the newest measurement when the command computed from it takes effect,
                                       by the board's clock. One period if nothing is late. */

/* Condition of a wait (WaitFingers) */
#define WAIT_ARRIVED 1              /* Every joint has been within finger.events.arrived_degrees of the set point
                                       sent last. */
#define WAIT_SETTLED 2              /* Since the set point sent last took effect, no joint has moved by more than
                                       finger.events.settled_degrees for finger.events.settled_ms. */

/* Condition of a reflex (Reflex.Condition) */
#define WHEN_EVENT 1                /* An event of the finger: Event. */
#define WHEN_OTHER_FINGER 2         /* An event of another finger: Event and Finger. */
#define WHEN_FORCE_ABOVE 3          /* The force of the surroundings on the tip is above Bound, N. */
#define WHEN_TENSION_ABOVE 4        /* The tension of any tendon is above Bound, N. */
#define WHEN_TENSION_BELOW 5        /* The tension of any tendon is below Bound, N. */
#define WHEN_JOINT_ABOVE 6          /* The angle of Joint is above Bound, rad. */
#define WHEN_JOINT_BELOW 7          /* The angle of Joint is below Bound, rad. */
#define WHEN_LINK_LOST 8            /* The board has not replied for Bound s. */
#define WHEN_PLANNER_SILENT 9       /* The planner has sent no set point for Bound s. */

/* Reaction of a reflex (Reflex.Reaction) */
#define THEN_STOP 1                 /* The finger stops with a fault. */
#define THEN_HOLD 2                 /* The finger stays where it is. */
#define THEN_SOFTEN 3               /* The tip gets the stiffness Kx. */
#define THEN_RETRACT 4              /* The finger goes to Pos. */
#define THEN_GRIP 5                 /* The tip presses harder by Value, N, but not harder than Most, N. It needs a Kx
                                       without an eigenvalue of 0. */
#define THEN_DAMP 6                 /* The tip gets the damping ratio Value. */

/* Result of GetStatus. */
struct FingerStatus {
    unsigned int Size;              /* In: sizeof (struct FingerStatus). Out: bytes written, at most that. */
    int State;                      /* FINGER_RUNNING to FINGER_CLOSED. */
    int Realtime;                   /* 1: all servo threads of the hand run under SCHED_FIFO. 0: at least one does
                                       not. */
    double Rate;                    /* Configured servo rate, Hz. */
    double MeasuredRate;            /* Measured servo rate since OpenHand, Hz: cycles divided by the time up to this
                                       call. It falls while the servo does not run. */
    double WakeUpMedian;            /* Jitter: median delay of the start of a cycle, since OpenHand or ResetTiming,
                                       us. */
    double WakeUp99;                /* Delay that 99 of 100 cycles did not exceed, over the same time, us. */
    double WakeUpMaximum;           /* Maximum delay over the same time, us. */
    double TorqueScale;             /* Fraction of the joint torque that the tension limits admitted in the last
                                       cycle, 0 to 1. The direction of the torque is kept. */
    unsigned long Cycles;           /* Cycles since OpenHand. */
    unsigned long SkippedPeriods;   /* Whole periods in which no cycle began because the previous cycle was not over
                                       or the servo thread did not run, up to now. One late cycle may skip many. */
    unsigned long LostReplies;      /* Cycles without a valid reply in time. */
    unsigned long DamagedFrames;    /* Pieces of bad data on the finger's port: damaged frames, truncated frames and
                                       noise. Whole frames that no finger expected count in
                                       FingerTiming.ForeignFrames. */
    double Calibration;             /* Progress of a calibration, 0 to 1. It is 0 if no calibration runs. */
    int MemoryLocked;               /* 1: OpenHand has locked the memory of every servo thread, so that no servo
                                       thread waits for a page. 0: the memory of at least one is not locked. If the
                                       planner calls munlockall later, this memory is unlocked too, and this member
                                       stays 1. CloseHand and OpenHand lock the memory again. */
    int OnCore;                     /* 1: each servo thread with a configured core runs on that core. 0: at least one
                                       does not. */
    double StiffnessScale;          /* Fraction of Kx in force in the last cycle, 0 to 1, with every controller and
                                       law. It is below 1 in poses in which the tendons cannot provide the whole Kx,
                                       for example near the straight pose. A joint beyond its limit can reduce it
                                       too, because the spring of the limit needs a part of what the tendons provide.
                                       GetTip gives the stiffness that results. */
};

/*
 Result of GetTiming. All times are in ns, accurate to 1 %, at most 4.29e9, and 0 if no cycle had
 the stage. All values count from OpenHand or the last ResetTiming of the finger.
 */
struct FingerTiming {
    unsigned int Size;              /* In: sizeof (struct FingerTiming). Out: bytes written, at most that. */
    int Stage;                      /* The requested stage. */
    unsigned long Count;            /* Cycles that had this stage. */
    unsigned long Minimum;          /* Shortest time of the stage. */
    unsigned long Median;           /* Half of the cycles took no longer. */
    unsigned long P99;              /* 99 of 100 cycles took no longer. */
    unsigned long P999;             /* 999 of 1000 cycles took no longer. */
    unsigned long Maximum;          /* Longest time of the stage. */
    unsigned long Cycles;           /* All cycles of the finger. This and the members below do not depend on Stage. */
    unsigned long Overruns;         /* Cycles that were not over when the next one was due. */
    unsigned long SkippedPeriods;   /* Whole periods in which no cycle began because the previous cycle was not over
                                       or the servo thread did not run, up to the last cycle. */
    unsigned long LostReplies;      /* Cycles without a valid reply in time. */
    unsigned long LateReplies;      /* Replies that arrived after the end of their cycle. */
    unsigned long CorruptReplies;   /* Pieces of bad data on the finger's port: damaged frames, truncated frames and
                                       noise. */
    unsigned long DuplicateReplies; /* Replies that arrived a second time. */
    unsigned long ForeignFrames;    /* Whole frames on the finger's port that no finger expected. */
};

/* Result of GetTip. Vectors are in the finger's frame. */
struct FingerTip {
    unsigned int Size;              /* In: sizeof (struct FingerTip). Out: bytes written, at most that. */
    int Felt;                       /* Number of directions of Force that the joints can measure: 3, or fewer near
                                       singular poses. */
    double Tip[3];                  /* Position of the tip: x, y, z, cm. */
    double Force[3];                /* Force of the tip on the object that it touches: x, y, z, N. It is computed
                                       from the measured tensions, so it includes friction, weight and inertia of the
                                       finger. It is never NaN, and is zero along directions that the joints cannot
                                       measure. */
    double Tensions[4];             /* Measured tendon tensions, N. */
    double Stiffness[3][3];         /* Stiffness of the tip in its present pose, N/cm, row by row: the fraction of Kx
                                       that is in force, plus what joint limits, nearness to the axis of joint 0 and
                                       the rotational stiffness of a contact add. It is zero along directions that
                                       the joints cannot measure, and while the finger is not running. */
    double Contact[3];              /* Force of the tip on the object that it touches: x, y, z, N, without friction,
                                       weight and inertia of the finger, and without constant errors of the gauges.
                                       It is zero while the finger is not running. */
    double Slide;                   /* Speed of the tip perpendicular to Contact, cm/s, while Touching: the tip
                                       slides on the object, or moves it. */
    int Touching;                   /* 1: according to tensions and motion, the finger touches something. 0: it does
                                       not. */
    int Unused;                     /* Always zero. */
};

/* Command to one finger of a group (SendGroup). */
struct FingerCommand {
    unsigned int Size;              /* sizeof (struct FingerCommand), the same in every command of the group. */
    int Finger;                     /* Finger, 1 to 3. */
    const double *Pos;              /* Pos[3] of SendPos, always double. Null: the pose stays, or is that of Tip. */
    const double *Tip;              /* Tip[3] of SendTip. Null: the pose stays, or is that of Pos. */
    const double *Kx;               /* Kx[9] of SendKx, row by row, always double. Null: the stiffness stays. */
    double Damping;                 /* Ratio of SendDamping. 0: the damping stays. */
};

/* Result of GetObject. Vectors are in the palm's frame. */
struct ObjectState {
    unsigned int Size;              /* In: sizeof (struct ObjectState). Out: bytes written, at most that. */
    int Touching;                   /* Number of fingers that touch the object. */
    double Time;                    /* Simulated time since OpenHand, s. It stops while the machine is too busy for
                                       the simulation. */
    double Position[3];             /* Position of the middle: x, y, z, cm. */
    double Rotation[3][3];          /* Rotation matrix from the object's frame to the palm's, row by row. At the
                                       start it is the unit matrix. */
    double Velocity[3];             /* Velocity of the middle, cm/s. */
    double Spin[3];                 /* Angular velocity, rad/s. */
    double Force[3][3];             /* Force of each finger on the object, N: Force[0] is that of finger 1. It is the
                                       true force, without the errors of GetTip. It is zero for a finger that does
                                       not touch the object. */
};

/* Result of GetTouch. */
struct FingerTouch {
    unsigned int Size;              /* In: sizeof (struct FingerTouch). Out: bytes written, at most that. */
    int Valid;                      /* 1 if the board has reported this element since OpenHand and could read it,
                                       otherwise 0. If it is 0, Pressed, Count and Force are 0 too. */
    int Pressed;                    /* 1 if something presses the element, otherwise 0. */
    unsigned int Count;             /* The raw count of the element. */
    double Force;                   /* Force on the element, N: its count minus its zero, times newton_per_count of
                                       the configuration. */
    unsigned long LostEvents;       /* Tactile events of the finger that were lost since OpenHand, because they did
                                       not fit into the queue of the board or because their element is not
                                       configured. */
};

/* Result of GetJointTorques. */
struct JointTorques {
    unsigned int Size;              /* In: sizeof (struct JointTorques). Out: bytes written, at most that. */
    double Measured[3];             /* Torques of joints 0, 1, 2 from the measured tensions, N cm. They include
                                       friction, weight and inertia. */
    double Commanded[3];            /* Torques that the servo commands, N cm, within the tension limits. */
};

/* Result of GetPalmPose. Positions and axes are in the palm's frame. */
struct PalmPose {
    unsigned int Size;              /* In: sizeof (struct PalmPose). Out: bytes written, at most that. */
    double Base[3];                 /* Origin of the finger's frame: x, y, z, cm. */
    double Rotation[3][3];          /* Axes of the finger's frame as columns, row by row. It turns a vector of the
                                       finger's frame into one of the palm's. */
    double Tip[3];                  /* Position of the tip, from the measured joint angles: x, y, z, cm. */
    double TipRotation[3][3];       /* Axes of the last link as columns, row by row. Its z axis points from joint 2
                                       to the tip. */
};

/* Pose of a path (SendPath). */
struct PathPose {
    unsigned int Size;              /* sizeof (struct PathPose), the same in every pose of the path. */
    int IsTip;                      /* 0: Place holds joint angles. Otherwise: Place holds a position of the tip. The
                                       same in every pose. */
    double Time;                    /* Time since the beginning of the path, s. */
    double Place[3];                /* Angles of joints 0, 1, 2, rad, or x, y, z of the tip in the finger's frame,
                                       cm. */
    const double *Kx;               /* Kx[9] of SendKx at this pose, row by row, always double. Null: the pose does
                                       not affect the stiffness. */
};

/* Result of GetRecord: one cycle of a finger, from the black box. */
struct FingerRecord {
    unsigned int Size;              /* In: sizeof (struct FingerRecord). Out: bytes written, at most that. */
    int State;                      /* FINGER_RUNNING to FINGER_CLOSED, at the end of the cycle. */
    unsigned long Cycle;            /* The cycle, counted from OpenHand; the first is 1. */
    unsigned long Oldest;           /* First cycle that is stored now. All cycles from Oldest to Newest are stored. */
    unsigned long Newest;           /* Last cycle that is stored now. */
    double Time;                    /* Start of the cycle on CLOCK_MONOTONIC, s. */
    int Answered;                   /* 1: the board's reply arrived. 0: it was lost. */
    int StatusBits;                 /* Status bits of the newest reply (docs/board-protocol.md). */
    int Computed;                   /* 1: the controller ran and computed the members below. 0: they are 0, because
                                       the finger was already faulted or a simulated finger had not answered. */
    int Follows;                    /* 1: PosSent is the set point in force. 0: none is in force, and PosSent is 0. */
    double Pos[3];                  /* Measured joint angles, rad. */
    double PosSent[3];              /* Joint angles at which the spring is anchored, rad. */
    double Tension[4];              /* Measured tendon tensions, N. */
    double TensionSent[4];          /* Commanded tendon tensions, N. */
    double Torque[4];               /* Commanded motor torques, N cm. They are sent to the board in the next cycle. */
};

/* Result of GetFault. */
struct Fault {
    unsigned int Size;              /* In: sizeof (struct Fault). Out: bytes written, at most that. */
    int Number;                     /* Fault that has stopped the finger: FAULT_..., or 0 if none has. */
    int Part;                       /* Part that has the fault: joint (0 to 2), or tendon, motor, gauge or encoder (1
                                       to 4). FaultText says which kind of part it is. 0 if the fault concerns the
                                       whole finger. */
    int Warning;                    /* Warning of the last second: FAULT_..., or 0 if there was none. */
    int WarningPart;                /* Part that the warning concerns, numbered as in Part. */
    double Value;                   /* Value of the fault: N, ms, degrees, counts, per cent, errno or status bits
                                       (docs/faults.md). */
    double WarningValue;            /* Value of the warning. */
    unsigned long Warnings;         /* Warnings since OpenHand. A warning that persists counts once. */
};

/* A rule for InstallReflex. Members that its condition and its reaction do not use are ignored. */
struct Reflex {
    unsigned int Size;              /* sizeof (struct Reflex). */
    int Condition;                  /* WHEN_EVENT to WHEN_PLANNER_SILENT. */
    int Event;                      /* EVENT_ constant for WHEN_EVENT and WHEN_OTHER_FINGER. */
    int Finger;                     /* The other finger for WHEN_OTHER_FINGER. */
    int Joint;                      /* Joint, 0 to 2, for WHEN_JOINT_ABOVE and WHEN_JOINT_BELOW. */
    int Reaction;                   /* THEN_STOP to THEN_DAMP. */
    int Priority;                   /* If several rules fire in one cycle, the one with the highest priority is
                                       first; 0 to 255. */
    int Reserved;                   /* Set it to 0. */
    double Bound;                   /* N, rad or s, as the condition says. */
    double Value;                   /* THEN_GRIP: increase of the force, N. THEN_DAMP: ratio. */
    double Most;                    /* THEN_GRIP: largest force, N. */
    double Refractory;              /* Time after a reaction in which the rule does not fire again, s, 0 to 3600. 0:
                                       the rule fires again only after its condition was false. */
    double Inhibition;              /* Time after a reaction in which the finger ignores set points of the planner,
                                       s, 0 to 3600. */
    double Pos[3];                  /* THEN_RETRACT: joint angles, rad. THEN_GRIP: direction in the finger's frame in
                                       which the tip presses harder; 0, 0, 0 for the direction in which its spring
                                       presses. */
    double Kx[3][3];                /* THEN_SOFTEN: stiffness, N/cm, row by row. */
};

/* An event: something that happened to a finger in one cycle of its servo. */
struct Event {
    unsigned int Size;              /* In: sizeof (struct Event). Out: bytes written, at most that. */
    int Finger;                     /* Finger, 1 to 3. */
    int Kind;                       /* Kind of the event: EVENT_... */
    int Part;                       /* Part of the finger that the event concerns: joint (0 to 2), or tendon, motor,
                                       gauge or encoder (1 to 4). 0 if the event concerns the whole finger. */
    unsigned long Cycle;            /* Number of the cycle to which the event belongs, as in FingerStatus.Cycles and
                                       FingerRecord.Cycle. */
    unsigned long Lost;             /* Events that were lost since OpenHand, the oldest first, because they were not
                                       taken in time. */
    double Time;                    /* Time at which this cycle began, s of CLOCK_MONOTONIC. All events of a cycle
                                       have the same time. */
    double Values[4];               /* Values, with the meanings and units of the kind (docs/events.md). Unused
                                       values are 0. */
};

/*
 GetStatus - rate, jitter and losses of a finger's servo

     int GetStatus(int i, struct FingerStatus *Status);

   i        finger, 1 to 3
   Status   result; set Status->Size before the call

 Works on a faulted finger too. A servo thread does not run while a thread with a higher priority
 occupies its core, or while a debugger stops it. Then State stays that of the last cycle, and Cycles
 does not grow. SkippedPeriods grows with every period, so a planner can compare it with an earlier
 value to compute how old the pose of GetPos is.

 Returns 0, or -1 with
   EPERM    forked child
   EFAULT   Status is null
   ENODEV   no hand is open
   EINVAL   Size is too small; no such finger

 Threads: any.

 Example:

     struct FingerStatus Status;
     Status.Size = sizeof Status;
     if (GetStatus(1, &Status) == 0)
         printf("%.1f Hz\n", Status.MeasuredRate);
 */
int GetStatus(int, struct FingerStatus *);

/*
 GetTiming - where the time of a finger's cycles goes

     int GetTiming(int i, int Stage, struct FingerTiming *Timing);

   i        finger, 1 to 3
   Stage    TIMING_WAKE_UP to TIMING_AGE
   Timing   result; set Timing->Size before the call

 Works while the servo runs, and on a faulted finger too.

 Returns 0, or -1 with
   EPERM    forked child
   EFAULT   Timing is null
   ENODEV   no hand is open
   EINVAL   Size is too small; no such finger; no such Stage

 Threads: any. Never waits for a servo. Takes a few us.

 Example:

     struct FingerTiming Timing;
     Timing.Size = sizeof Timing;
     if (GetTiming(1, TIMING_WIRE, &Timing) == 0)
         printf("%lu ns\n", Timing.P99);
 */
int GetTiming(int, int, struct FingerTiming *);

/*
 ResetTiming - restart the counts of GetTiming

     int ResetTiming(int i);

   i        finger, 1 to 3; 0: all

 The counts of GetStatus continue. The wake-up times of GetStatus restart, because they are those of
 GetTiming.

 Returns 0, or -1 with
   EPERM    forked child
   ENODEV   no hand is open
   EINVAL   no such finger

 Threads: any. Never waits for a servo.
 */
int ResetTiming(int);

/*
 SendTip - send a desired fingertip position to a finger

     int SendTip(int i, const double *Tip);

   i     finger, 1 to 3
   Tip   Tip[3]: desired x, y, z of the tip in the finger's frame (chapter 3), cm. Always double

 From the next cycle on the anchor of the fingertip's spring moves to Tip, along a straight line in
 joint angles and at a bounded speed. The stiffness is the one sent last. When the anchor is at Tip
 and p is the position of the fingertip, the force is Kx (Tip - p) at any distance, whatever the
 configured controller.law. If several joint solutions are within the joint limits, the call takes
 the one nearest to the present pose.

 Returns 0, or -1 with
   EPERM    forked child
   EFAULT   Tip is null
   ENODEV   no hand is open
   EINVAL   no such finger; an entry is NaN or infinite
   ERANGE   Tip is too far, too near, or outside the joint limits; it is never clamped
   EIO      the finger is faulted

 Threads: any. Never waits for a servo. Takes less than 1 us.

 Example:

     double Tip[3] = {0.0, -6.0, 8.0};
     SendTip(1, Tip);
 */
int SendTip(int, const double *);

/*
 GetTip - read position, force and stiffness of a fingertip, and the tendon tensions

     int GetTip(int i, struct FingerTip *Tip);

   i     finger, 1 to 3
   Tip   result, from the last cycle of the servo; set Tip->Size before the call

 Returns 0, or -1 with
   EPERM    forked child
   EFAULT   Tip is null
   ENODEV   no hand is open
   EINVAL   Size is too small; no such finger
   EIO      the finger is faulted

 Threads: any. Never waits for a servo. Takes about 1 us.

 Example:

     struct FingerTip Tip;
     Tip.Size = sizeof Tip;
     if (GetTip(1, &Tip) == 0)
         printf("%g N along z\n", Tip.Force[2]);
 */
int GetTip(int, struct FingerTip *);

/*
 SendContact - make a fingertip the spring of a contact type

     int SendContact(int i, int D, const double *K, const double *Normal);

   i        finger, 1 to 3
   D        dimensions of the contact (section 4.2 of the report):
            1   frictionless point: a force along the normal
            3   hard finger with friction: three forces; SendContact (i, 3, Kx, 0) is the same as
                SendKx (i, Kx)
            4   soft finger: three forces and a moment about the normal
   K        K[D][D] or K[D * D], row by row. Always double. For D = 1: N/cm along the normal. For
            D = 3 and 4, rows and columns 0 to 2 are x, y, z of the finger's frame, N/cm. For D = 4,
            row and column 3 are the rotation about the normal: N cm/rad on the diagonal, else N/rad
   Normal   Normal[3]: the contact normal in the finger's frame, of any length but zero. Always
            double. Not used for D = 3, and may be null there

 The contact takes effect as a whole, without a jump in torque. It replaces the stiffness sent last,
 and a later SendKx replaces it. In directions outside the contact, the finger is limp but still
 damped. K must be symmetric and must have no negative eigenvalue, as for SendKx. To compare it with
 the bound, a rotational stiffness of k N cm/rad is converted to k / (l2 l2) N/cm, where l2 is the
 length of the last link.

 D = 4 is not a spring in four independent directions, because three joints turn the tip only by
 moving it. A tip that moves by v cm turns about Normal by c . v rad, and the vector c depends on the
 pose. A rotational stiffness of k N cm/rad therefore stiffens the tip along c, by k |c| |c| N/cm, and
 the tip exerts no moment that is independent of its force. In the pose 0, 0.5, 0.8 rad the example
 below gives 3.24, 3 and 3 N/cm along x, y and z. With Normal along x it gives 3, 3.56 and 4.87 N/cm,
 and -1.02 N/cm between y and z. Stiffness of GetTip is the stiffness that results.

 Returns 0, or -1 with
   EPERM    forked child
   EFAULT   K is null; Normal is null for D = 1 or 4
   ENODEV   no hand is open
   EINVAL   no such finger; no such D; an entry is NaN or infinite
   EDOM     K is not symmetric, or has a negative eigenvalue; Normal is zero
   ERANGE   K is stiffer than the bound (hand.out_of_range = "clamp" clamps it instead)
   EIO      the finger is faulted
   ERANGE   K is too stiff for the ratio of SendDamping ("clamp" clamps the ratio instead)

 Threads: any. Never waits for a servo. Takes a few us.

 Example, a soft finger:

     double K[4][4] = {{3, 0, 0, 0}, {0, 3, 0, 0}, {0, 0, 3, 0}, {0, 0, 0, 20}};
     double Normal[3] = {0, -1, 0};
     SendContact(1, 4, &K[0][0], Normal);
 */
int SendContact(int, int, const double *, const double *);

/*
 SendDamping - set the damping of a fingertip

     int SendDamping(int i, double Ratio);

   i       finger, 1 to 3
   Ratio   damping relative to what the controller chooses from the stiffness; 1 after OpenHand

 The ratio changes without a jump in torque and stays until another ratio is sent. A finger with
 much less or much more damping does not come to rest. The range therefore depends on controller,
 rate and the largest eigenvalue k of the stiffness, N/cm:

                                     1000 Hz and above    below 1000 Hz
   state feedback         smallest   0.40 + 0.09 k        0.70 + 0.07 k
                          largest    2.50 - 0.22 k        2.00 - 0.20 k
   figures 9, 10, 11      smallest   1                    1
                          largest    2.50 - 0.22 k        2.00 - 0.20 k

 By default the range is 0.67 to 1.84 at 3 N/cm and 0.94 to 1.18 at 6 N/cm. It always includes 1.
 For a finger with other links or tendons, k is first multiplied by 12.3 N/cm divided by S. S is
 the smallest stiffness that the tendons give the tip in any direction, with locked motors and with
 the joints in the middle of their ranges. For the default finger S is 12.3 N/cm. SendKx and
 SendContact refuse a stiffness whose range does not include the ratio sent last.

 Returns 0, or -1 with
   EPERM    forked child
   ENODEV   no hand is open
   EINVAL   no such finger; Ratio is NaN or infinite
   EIO      the finger is faulted
   ERANGE   Ratio is outside the range that HandError gives (hand.out_of_range = "clamp" clamps it)

 Threads: any. Never waits for a servo. Takes about 100 ns.
 */
int SendDamping(int, double);

/*
 AdjustFinger - change the configuration of a finger while it runs

     int AdjustFinger(int i, const char *Keys);

   i      finger, 1 to 3
   Keys   lines of TOML, in UTF-8, as under [finger.i] of the configuration file (chapter 8)

 All keys take effect together, within a cycle and without a jump in torque; other keys stay as they
 are. The change lasts until CloseHand: the file is not written. A new controller.law applies from
 the next SendPos on. These keys cannot change while the hand is open: port, baud, reconnect,
 address, thread, core, priority, base, turn_degrees, encoder, motor.sign, motor.torque_limit,
 motor.torque_constant, stiffness.initial and simulation.

 A configured stiffness.bound was chosen for the configured controller.scheme. If Keys changes
 controller.scheme but does not set stiffness.bound, the smaller of the configured bound and the
 default bound applies.

 Returns 0, or -1 with
   EPERM    forked child
   EFAULT   Keys is null
   ENODEV   no hand is open
   EINVAL   no such finger; Keys is not TOML
   EBUSY    a key cannot change while the hand is open
   EINVAL   an unknown key; an unusable configuration
   ERANGE   the position or stiffness sent last is outside the new limits (hand.out_of_range =
            "clamp" clamps it instead)
   EIO      the finger is faulted

 Threads: any. Never waits for a servo. Takes about 200 us, and allocates memory.

 Example:

     AdjustFinger(1, "tendon.minimum = 6\ncontroller.tension_gain = 3");
 */
int AdjustFinger(int, const char *);

/*
 PushFinger - push the fingertip of a simulated finger

     int PushFinger(int i, const double *Force);

   i       finger, 1 to 3
   Force   Force[3]: force on the fingertip along x, y, z of the finger's frame, N. Always double. It
           acts until the next call; zero ends it

 Returns 0, or -1 with
   EPERM    forked child
   EFAULT   Force is null
   ENODEV   no hand is open
   EINVAL   no such finger; an entry is NaN or infinite
   ENOTSUP  the finger is on a real port
   ERANGE   a component is beyond 1000 N

 Threads: any.
 */
int PushFinger(int, const double *);

/*
 SendJointStiffness - make the joints of a finger springs

     int SendJointStiffness(int i, const double *K);

   i     finger, 1 to 3
   K     K[3][3] or K[9], row by row: entry [row][column] is the torque of joint row for a deflection
         of joint column from its set point, N cm/rad. Always double

 The torque of the joints is K (Pos - p), with the desired angles Pos and the measured angles p of
 joints 0, 1 and 2. K takes effect like Kx, without a jump in torque: 95 % of the change has taken
 effect after 50 ms. It replaces the Kx or contact that was sent last, and a later SendKx,
 SendContact, or Kx of SendGroup or SendPath replaces it. The torque of SendJointTorque stays. K must
 be symmetric and must have no negative eigenvalue, as for SendKx. It may be zero.

 The largest eigenvalue of K may be at most the bound of Kx times l2 l2, where l2 is the length of the
 last link: by default 96 N cm/rad at 1000 Hz and above, and 80 N cm/rad below. This is the stiffness
 that a Kx at its bound gives joint 2 in every pose.

 Returns 0, or -1 with
   EPERM    forked child
   EFAULT   K is null
   ENODEV   no hand is open
   EINVAL   no such finger; an entry is NaN or infinite
   EDOM     K is not symmetric, or has a negative eigenvalue
   ERANGE   K is stiffer than the bound (hand.out_of_range = "clamp" clamps it instead)
   EIO      the finger is faulted
   ERANGE   K is too stiff for the ratio of SendDamping ("clamp" clamps the ratio instead)

 Threads: any. Never waits for a servo. Takes a few us.

 Example:

     double K[3][3] = {{80, 0, 0}, {0, 80, 0}, {0, 0, 50}};
     SendJointStiffness(1, &K[0][0]);
 */
int SendJointStiffness(int, const double *);

/*
 SendJointTorque - add a constant torque to the joints of a finger

     int SendJointTorque(int i, const double *Torque);

   i        finger, 1 to 3
   Torque   Torque[3]: torque of joints 0, 1, 2, N cm; positive torques increase the angles. Always
            double

 The torque acts in addition to the spring of Kx, of a contact or of SendJointStiffness, until the
 next call replaces it; zero ends it. It takes effect like Kx, without a jump. If the stiffness is
 zero, the finger is controlled by torque alone: a free finger then moves to its joint limits, at a
 speed that only damping and friction limit. A fault, a calibration, the reactions of reflexes that
 hold, retract or soften the finger, and a set point that expires end the torque.

 A torque is refused if it needs more tension than a tendon and its motor permit. If the spring, the
 compensation of gravity and the torque together need more, the servo scales their sum down.

 Returns 0, or -1 with
   EPERM    forked child
   EFAULT   Torque is null
   ENODEV   no hand is open
   EINVAL   no such finger; a torque is NaN or infinite
   ERANGE   the tendons cannot make Torque (hand.out_of_range = "clamp" scales it instead)
   EIO      the finger is faulted

 Threads: any. Never waits for a servo. Takes about 1 us.

 Example:

     double Torque[3] = {0, 3, 1.5};
     SendJointTorque(1, Torque);
 */
int SendJointTorque(int, const double *);

/*
 SendGroup - command several fingers in the same cycle

     int SendGroup(int Count, const struct FingerCommand *Commands);

   Count      number of commands, 0 to 3
   Commands   Commands[Count]: one command for each finger of the group, in any order; set Size of
              every command, and set members that are not used to 0

 Each command has the effect of SendPos or SendTip, SendKx and SendDamping. All fingers of the group
 follow their commands from the same cycle on, also if different threads serve them: the periods of
 the servos are numbered for the whole hand, and the group takes effect in the same period for every
 finger, within two periods. If the call is refused, no finger gets its command.

 If a servo is so late that it skips this period, its finger follows in its next cycle. With
 hand.clock = "board" the periods of the threads follow different clocks. Then a finger may follow
 one period later, about once in the time in which two of the clocks differ by a period.

 Returns 0, or -1 with
   EPERM    forked child
   EFAULT   Commands is null
   ENODEV   no hand is open
   EINVAL   Size is too small; Count is not 0 to 3; no such finger; two commands for one finger, or
            Pos and Tip for one finger; an entry is NaN or infinite
   EDOM, ERANGE  as SendPos, SendTip, SendKx and SendDamping
   EIO      a finger of the group is faulted
   EBUSY    16 groups of a finger have not taken effect yet, because they are sent faster than one in
            a period, or the servo does not run

 Threads: any. Never waits for a servo. Takes a few us.

 Example, two fingers close together:

     double Pos1[3] = {0.0, 0.5, 0.8}, Pos2[3] = {0.0, 0.6, 0.9};
     static struct FingerCommand Commands[2];

     Commands[0].Size = Commands[1].Size = sizeof Commands[0];
     Commands[0].Finger = 1;
     Commands[0].Pos = Pos1;
     Commands[1].Finger = 2;
     Commands[1].Pos = Pos2;
     SendGroup(2, Commands);
 */
int SendGroup(int, const struct FingerCommand *);

/*
 WaitFingers - wait until fingers have arrived or settled

     int WaitFingers(int Count, const int *Fingers, int Until, double Limit);

   Count     number of fingers, 0 to 3
   Fingers   Fingers[Count]: the fingers, 1 to 3
   Until     WAIT_ARRIVED or WAIT_SETTLED
   Limit     longest time to wait, s

 Waits until the condition holds for every finger. Returns at once if it holds already. A finger
 that an object blocks settles without arriving. With a set point of SendTip or a group, the joint
 angles are those that the call has computed. Other calls work meanwhile. CloseHand works too, and
 this call is then refused.

 Returns 0, or -1 with
   EPERM    forked child
   EFAULT   Fingers is null
   ENODEV   no hand is open, or it was closed meanwhile
   EINVAL   Count is not 0 to 3; no such finger; no such Until; Limit is negative or NaN
   EIO      a finger is faulted
   EBUSY    a finger is limp, calibrated or closed
   ETIMEDOUT  Limit is over; HandError names a finger that has not arrived or settled

 Threads: any.

 Example:

     int Fingers[2] = {1, 2};
     if (WaitFingers(2, Fingers, WAIT_SETTLED, 5.0) != 0)
         fprintf(stderr, "%s\n", HandError());
 */
int WaitFingers(int, const int *, int, double);

/*
 GetObject - read pose and motion of the object in the simulated hand

     int GetObject(struct ObjectState *Object);

   Object   result, some milliseconds old at most; set Object->Size before the call

 All simulated fingers touch one object if hand.simulated_object is configured: a ball or a box with
 mass, friction and gravity, on a table or not. hand.gravity is its gravity.

 Returns 0, or -1 with
   EPERM    forked child
   EFAULT   Object is null
   ENODEV   no hand is open
   EINVAL   Size is too small
   ENOTSUP  no object is configured; no finger is simulated

 Threads: any. Never waits for a servo or for the simulation. Takes less than 1 us.

 Example:

     struct ObjectState Object;
     Object.Size = sizeof Object;
     if (GetObject(&Object) == 0)
         printf("z is %g cm, %d fingers touch\n", Object.Position[2], Object.Touching);
 */
int GetObject(struct ObjectState *);

/*
 GetTouch - the newest reading of a tactile element

     int GetTouch(int i, int Element, struct FingerTouch *Touch);

   i        finger, 1 to 3
   Element  element, from 0, in the order of [finger.touch] in the configuration
   Touch    result; set Touch->Size before the call

 A board reports an element when its reading changes. The servo fetches one such event of a finger in each period in
 which the line has time for it. A faulted finger keeps its last readings.

 Returns 0, or -1 with
   EPERM    forked child
   EFAULT   Touch is null
   ENODEV   no hand is open
   EINVAL   Size is too small; no such finger; no such Element

 Threads: any. Never waits for a servo. Takes a few us.

 Example:

     struct FingerTouch Touch;
     Touch.Size = sizeof Touch;
     if (GetTouch(1, 0, &Touch) == 0 && Touch.Valid)
         printf("%.3f N\n", Touch.Force);
 */
int GetTouch(int, int, struct FingerTouch *);

/*
 TareTouch - make the present readings of a finger's tactile elements their zeros

     int TareTouch(int i);

   i        finger, 1 to 3

 Call TareTouch while nothing touches the finger. An element without a valid reading keeps its zero. The zeros are in
 force until CloseHand. The configuration keeps its own zeros.

 Returns 0, or -1 with
   EPERM    forked child
   ENODEV   no hand is open
   EINVAL   no such finger

 Threads: any. Never waits for a servo. Takes a few us.

 Example:

     TareTouch(1);
 */
int TareTouch(int);

/*
 GetJacobian - compute the Jacobian of a fingertip

     int GetJacobian(int i, const double *Pos, double *J);

   i     finger, 1 to 3
   Pos   Pos[3]: angles of joints 0, 1, 2, rad; always double. Null: the measured angles
   J     result: J[3][3] or J[9], row by row; always double. J[row][column] is the motion of the tip
         along axis row (x, y, z of the finger's frame) for joint column, cm/rad (eq. 8)

 A force f on the tip acts on joint k as the sum over the axes of J[axis][k] f[axis], N cm.

 Returns 0, or -1 with
   EPERM    forked child
   EFAULT   J is null
   ENODEV   no hand is open
   EINVAL   no such finger; an angle is NaN or infinite
   EIO      Pos is null and the finger is faulted

 Threads: any. Never waits for a servo.

 Example:

     double J[3][3];
     if (GetJacobian(1, NULL, &J[0][0]) == 0)
         printf("%g cm/rad\n", J[0][0]);
 */
int GetJacobian(int, const double *, double *);

/*
 FindTip - compute where a tip is at given joint angles

     int FindTip(int i, const double *Pos, double *Tip);

   i     finger, 1 to 3
   Pos   Pos[3]: angles of joints 0, 1, 2, rad; they may be outside the joint limits. Always double
   Tip   result: Tip[3]: x, y, z of the tip in the finger's frame, cm. Always double

 Returns 0, or -1 with
   EPERM    forked child
   EFAULT   Pos or Tip is null
   ENODEV   no hand is open
   EINVAL   no such finger; an angle is NaN or infinite

 Threads: any. Never waits for a servo.

 Example:

     double Pos[3] = {0.0, 0.5, 0.8}, Tip[3];
     FindTip(1, Pos, Tip);
 */
int FindTip(int, const double *, double *);

/*
 FindPos - compute the joint angles at which a tip is at a position

     int FindPos(int i, const double *Tip, double *Pos);

   i     finger, 1 to 3
   Tip   Tip[3]: x, y, z of the tip in the finger's frame, cm. Always double
   Pos   result: Pos[3]: angles of joints 0, 1, 2, rad. Always double

 If several joint solutions are within the joint limits, the result is the one nearest to the
 present pose, as with SendTip.

 Returns 0, or -1 with
   EPERM    forked child
   EFAULT   Tip or Pos is null
   ENODEV   no hand is open
   EINVAL   no such finger; an entry is NaN or infinite
   ERANGE   Tip is too far, too near, or outside the joint limits

 Threads: any. Never waits for a servo.

 Example:

     double Tip[3] = {0.0, -6.0, 8.0}, Pos[3];
     if (FindPos(1, Tip, Pos) == 0)
         printf("%g %g %g\n", Pos[0], Pos[1], Pos[2]);
 */
int FindPos(int, const double *, double *);

/*
 GetJointTorques - read the joint torques of a finger

     int GetJointTorques(int i, struct JointTorques *Torques);

   i         finger, 1 to 3
   Torques   result, from the last cycle of the servo; set Torques->Size before the call

 Returns 0, or -1 with
   EPERM    forked child
   EFAULT   Torques is null
   ENODEV   no hand is open
   EINVAL   Size is too small; no such finger
   EIO      the finger is faulted

 Threads: any. Never waits for a servo.
 */
int GetJointTorques(int, struct JointTorques *);

/*
 GetPalmPose - read where a finger and its tip are in the palm

     int GetPalmPose(int i, struct PalmPose *Pose);

   i      finger, 1 to 3
   Pose   result, from the last cycle of the servo; set Pose->Size before the call

 Base and Rotation follow from the configuration, finger.base and finger.turn_degrees. By default
 two fingers are side by side, and the thumb is opposite to them.

 Returns 0, or -1 with
   EPERM    forked child
   EFAULT   Pose is null
   ENODEV   no hand is open
   EINVAL   Size is too small; no such finger
   EIO      the finger is faulted

 Threads: any. Never waits for a servo.
 */
int GetPalmPose(int, struct PalmPose *);

/*
 SetGravity - set gravity in the palm's frame, for a hand on a moving arm

     int SetGravity(const double *Gravity);

   Gravity   Gravity[3]: gravity along x, y, z of the palm's frame, m/s^2. Always double

 Replaces hand.gravity until CloseHand. Every finger compensates the new gravity within a cycle and
 without a jump in torque. It also acts on simulated fingers and on a simulated object. The monitors
 begin again with every change, so a planner should not change gravity more often than it needs.

 Returns 0, or -1 with
   EPERM    forked child
   EFAULT   Gravity is null
   ENODEV   no hand is open
   EINVAL   an entry is NaN, infinite or beyond 100 m/s^2
   EIO      a finger is faulted; the other fingers have the new gravity, and this finger needs another
            call after RecoverHand

 Threads: any. Never waits for a servo. Takes some hundred us, and allocates memory.

 Example, a palm whose x axis points down:

     double Gravity[3] = {9.81, 0, 0};
     SetGravity(Gravity);
 */
int SetGravity(const double *);

/*
 SendPath - send a timed path to a finger

     int SendPath(int i, int Count, const struct PathPose *Poses, double ValidMs);

   i         finger, 1 to 3
   Count     number of poses, 1 to 128
   Poses     Poses[Count], in the order of their times; set Size of every pose
   ValidMs   how long the end of the path is valid, ms; 0 for finger.motion.valid_ms

 The path begins at once where the anchor of the fingertip's spring is, continues its motion, passes
 every pose at its time and rests at the last one. Between poses the joint angles, or the tip, follow
 a spline. From rest to a single position of the tip, the tip moves along a straight line. Speed,
 acceleration and jerk are continuous. Because they are fed forward, the finger follows without the
 lag of SendPos. Kx changes linearly from the last pose that has a Kx, or from the beginning.

 The whole path is checked before anything moves: against the joint limits, and against speed,
 acceleration and jerk of finger.motion. With hand.out_of_range = "clamp" a path that is too fast is
 made slower as a whole instead. Another path, SendPos or SendTip replaces the path without a jump,
 even while the finger follows it. A Kx that is sent while a path runs takes effect at once, and the path no longer
 changes Kx. After a refused call the finger continues as before.

 Returns 0, or -1 with
   EPERM    forked child
   EFAULT   Poses is null
   ENOMEM   there is not enough memory for the computation
   ENODEV   no hand is open
   EINVAL   Size is too small; no such finger; Count is not 1 to 128; a time is less than 1 ms later
            than the one before; joint angles and tip positions are mixed; an entry is NaN or infinite
   EDOM     a Kx is not symmetric, or has a negative eigenvalue
   ERANGE   a pose or a place between two poses is out of reach or outside the joint limits, a Kx is
            too stiff, or the path is too fast; HandError names the pose, and the factor by which the
            path must be slower
   EIO      the finger is faulted
   EBUSY    the finger is being opened or calibrated, or is limp
   EAGAIN   the finger has become a spring again during the call

 Threads: any. Never waits for a servo. Takes about 1 ms, depending on the number of poses.

 Example:

     static struct PathPose Poses[2];

     Poses[0].Size = Poses[1].Size = sizeof Poses[0];
     Poses[0].Time = 0.5;
     Poses[0].Place[1] = 0.5, Poses[0].Place[2] = 0.8;
     Poses[1].Time = 1.0;
     Poses[1].Place[1] = 0.7, Poses[1].Place[2] = 1.1;
     if (SendPath(1, 2, Poses, 0) != 0)
         fprintf(stderr, "%s\n", HandError());
 */
int SendPath(int, int, const struct PathPose *, double);

/*
 SendPosFor - send desired joint angles that expire

     int SendPosFor(int i, const double *Pos, double ValidMs);

   i         finger, 1 to 3
   Pos       Pos[3]: desired angles of joints 0, 1, 2, rad, as for SendPos. Always double
   ValidMs   how long the angles are valid, ms; 0 for finger.motion.valid_ms

 Has the effect of SendPos. If no other command of the planner arrives within ValidMs, the finger no
 longer follows the angles: by default it holds the pose in which it then is with the soft
 finger.motion.expired_stiffness. With finger.motion.on_expiry = "end state" it faults.

 Returns 0, or -1 with
   EPERM    forked child
   EFAULT   Pos is null
   ENODEV   no hand is open
   EINVAL   ValidMs is NaN, negative or more than 3600000; no such finger; an angle is NaN or infinite
   ERANGE   an angle is outside the joint limits (hand.out_of_range = "clamp" clamps it instead)
   EIO      the finger is faulted

 Threads: any. Never waits for a servo. Takes about 200 ns.

 Example, from a planner that sends every 20 ms:

     double Pos[3] = {0.0, 0.5, 0.8};
     SendPosFor(1, Pos, 60.0);
 */
int SendPosFor(int, const double *, double);

/*
 GetRecord - one cycle of the last two seconds of a finger

     int GetRecord(int i, unsigned long Cycle, struct FingerRecord *Record);

   i        finger, 1 to 3
   Cycle    a cycle from Record->Oldest to Record->Newest of an earlier call; 0: the newest cycle
   Record   result; set Record->Size before the call

 A record is a part of what WriteBlackBox writes into a file. Every cycle adds a record and removes
 the oldest one. A faulted finger adds none, so its records are the last ones before the fault.

 Returns 0, or -1 with
   EPERM    forked child
   EFAULT   Record is null
   ENODEV   no hand is open
   EINVAL   Size is too small; no such finger
   ENOENT   the cycle is no longer stored, or has not taken place yet

 Threads: any. Never waits for a servo.

 Example, which prints the newer half of the records:

     struct FingerRecord Record;
     unsigned long Cycle, Last;
     Record.Size = sizeof Record;
     if (GetRecord(1, 0, &Record) == 0) {
         Last = Record.Newest;
         for (Cycle = (Record.Oldest + Last) / 2; Cycle <= Last; Cycle++)
             if (GetRecord(1, Cycle, &Record) == 0)
                 printf("%f %f\n", Record.Time, Record.Tension[0]);
     }
 */
int GetRecord(int, unsigned long, struct FingerRecord *);

/*
 WriteBlackBox - write the last seconds of a finger into a file

     int WriteBlackBox(int i, const char *Path);

   i       finger, 1 to 3
   Path    the file; an existing file is replaced

 The library stores the last two seconds of every finger: feedback, set points, motor commands,
 timing and state. For a faulted finger these are the last two seconds before the fault.
 docs/black-box.md describes the file, and `sun2xp replay Path` recomputes its cycles. If
 hand.black_box is set, the library also writes such a file whenever a finger faults.

 The library writes a temporary file in the same folder, whose name begins with ".sun2xp-", and
 renames it when it is complete and on the disk. So the folder must be writable, and a refused call
 leaves an old file unchanged. The call takes about 50 ms plus the time that the disk needs for some
 MB. The servos continue.

 Returns 0, or -1 with
   EPERM    forked child
   EFAULT   Path is null
   ENODEV   no hand is open
   EINVAL   no such finger; Path names something other than a regular file, such as a symbolic link,
            a device or a folder
   ENOENT, EACCES, ENOSPC ...  the file cannot be written

 Threads: any. If two calls write to the same Path, the file of the last one remains.

 Example:

     WriteBlackBox(1, "finger-1.jsonl");
 */
int WriteBlackBox(int, const char *);

/*
 ZeroFinger - find the zeros of a finger's gauges and encoders

     int ZeroFinger(int i);

   i        finger, 1 to 3

 Slackens the tendons and reads the gauges. Then finds the zero of the encoders by
 finger.zeroing.method:

   "pose"   The finger stands in finger.zeroing.pose_degrees. It must stand still from the start of
            the call until it has been read: 0.3 s for a finger that is a spring, some seconds for a
            limp one, which a jig or a hand must hold. A finger that moves, or that nothing holds,
            is refused.
   "stops"  Each joint moves slowly against both of its stops. The finger needs room for that.
   "kept"   The configured zero stays, if the board reports that its counts are still valid.

 The default is "stops" if the finger is simulated or the configuration gives the positions of its
 stops, otherwise "pose". At the end the finger holds its present pose at its initial stiffness. A
 free finger may have moved by up to some tenths of a radian while it was limp.

 The zeros take effect at once. If OpenHand has read a configuration file, they are written into
 that file. All its other keys and comments stay, including those that have changed since OpenHand.
 Several processes may store their results in one file: each waits for the others, at most 30 s.

 Waits until all this is done: some seconds, or up to a minute with "stops". Meanwhile
 FingerStatus.Calibration gives the progress, other calls work, and set points for this finger have
 no effect.

 Returns 0, or -1 with
   EPERM      forked child
   ENODEV     no hand is open, or it was closed meanwhile
   EINVAL     no such finger; or the configuration file has changed, and the zeros do not fit it:
              they are in force until CloseHand and not stored
   EIO        the finger is faulted
   EBUSY      the finger is being calibrated or recovered already
   ECANCELED  the calibration failed (the finger moved in its pose, a tendon is slack, a gauge is
              dead, a joint meets no stop or meets it too early ...). No zero has changed, and
              HandError gives the remedy. The finger is then limp. Exception: if it moved while it
              was read, or if its counts were not valid, the calibration had not changed anything
              yet, and the finger is in its former state. If another thread has recovered the finger
              from a fault during the calibration, the finger holds its pose, with its former zeros
   ETIMEDOUT  not finished within finger.zeroing.time_limit_s; otherwise as with ECANCELED
   EACCES, ENOSPC ...  the configuration file cannot be written; the zeros are in force until
              CloseHand

 Threads: any.

 Example:

     if (ZeroFinger(1) != 0)
         fprintf(stderr, "%s\n", HandError());
 */
int ZeroFinger(int);

/*
 IdentifyFinger - measure gauge gains, friction and tendon stiffness of a finger

     int IdentifyFinger(int i);

   i        finger, 1 to 3; it must have been zeroed

 Moves the joints back and forth around their present angles, moves each joint between its two stops,
 presses against the lower stops with up to 0.6 of the largest tension, and returns to the start.
 Measures the gains of the gauges, the stiffness of each tendon, its moment arms, and the friction of
 motors, conduits, pulleys and joints. The results take effect and are stored like those of ZeroFinger.
 Takes about 80 s, and needs free space over the whole range of the joints.

 Returns and waits as ZeroFinger does.

 Threads: any.
 */
int IdentifyFinger(int);

/*
 GetFault - fault and warning of a finger

     int GetFault(int i, struct Fault *Fault);

   i        finger, 1 to 3
   Fault    result; set Fault->Size before the call

 Returns 0, with or without a fault, or -1 with
   EPERM    forked child
   EFAULT   Fault is null
   ENODEV   no hand is open
   EINVAL   Size is too small; no such finger

 Threads: any. Never waits for a servo.

 Example:

     struct Fault Fault;
     Fault.Size = sizeof Fault;
     if (GetFault(1, &Fault) == 0 && Fault.Number != 0)
         fprintf(stderr, "finger 1: %s\n", FaultText(Fault.Number));
 */
int GetFault(int, struct Fault *);

/*
 FaultText - description of a fault

     const char *FaultText(int Number);

   Number   FAULT_...

 Returns one line with the fault's name, its meaning, the likely cause and the remedy, or an empty
 string if no fault has this number. The pointer is never null, and the text stays valid until the
 process ends. If a call was refused because of a fault, HandError gives the same text with the part
 and the values.

 Threads: any. Works in a forked child too.
 */
const char *FaultText(int);

/*
 StopHand - emergency stop

     int StopHand(void);

 Every finger faults (FAULT_EMERGENCY_STOP_CALL) at the start of its next cycle. The servo commands
 its board to enter the configured end state, and calls for the finger are refused with EIO until
 RecoverHand, or CloseHand and OpenHand. If no hand is open, the call does nothing; a hand that is
 opened later is not affected.

 With hand.end_state = "release", the default, the torque goes to zero at once. With "hold" the
 motors keep their last torque, up to hand.hold_torque_limit, for hand.hold_time_ms, by default 2 s
 and at most a minute. Configure "hold" only for objects that must not be dropped: no call releases
 the torque earlier. Only the emergency stop input of the board, or cutting the board's power, does.

 StopHand is not a safety function: it needs this process, this machine and the cable.

 Returns 0.

 Threads: any, and signal handlers: it is async-signal-safe, does not set errno and waits for
 nothing. In a forked child it does nothing.

 Example, for Control-C:

     static void OnInterrupt(int Signal)
     {
         (void)Signal;
         StopHand();
     }

     signal(SIGINT, OnInterrupt);
 */
int StopHand(void);

/*
 StopFinger - stop one finger

     int StopFinger(int i);

   i        finger, 1 to 3

 The finger faults (FAULT_STOP_CALL) at the start of its next cycle, and its board enters the
 configured end state, as with StopHand. The other fingers continue, unless hand.on_fault is "hand".
 The finger stays stopped until RecoverHand, or CloseHand and OpenHand. A finger that has faulted
 already stays as it is. Like StopHand, this is not a safety function. Unlike StopHand, it must not be
 called in a signal handler.

 Returns 0, or -1 with
   EPERM    forked child
   ENODEV   no hand is open
   EINVAL   no such finger

 Threads: any. Never waits for a servo.
 */
int StopFinger(int);

/*
 RecoverHand - make a faulted finger a spring again

     int RecoverHand(int i);

   i        finger, 1 to 3

 Queries the identity of the finger's board and configures the board again. If the port has failed
 and finger.reconnect is true, reopens the port first. Then brings the tendons under tension. The
 finger holds its present pose at the configured initial stiffness. If another finger on the same
 port runs, it continues unchanged, and only finger i recovers. Otherwise all fingers on the port
 recover together. A finger that is not faulted continues unchanged. Remove the cause of the fault
 first: GetFault and FaultText name it.

 Waits until the finger holds its pose or faults again, up to some seconds. Other calls work
 meanwhile. CloseHand works too, and this call is then refused.

 Returns 0, or -1 with
   EPERM    forked child
   ENODEV   no hand is open, or it was closed meanwhile; or the port has failed and finger.reconnect
            is false
   EINVAL   no such finger
   EIO      the finger faults again; or its board is not the one found by OpenHand, or has lost its
            zero; or its servo thread has failed (FAULT_SERVO_PANIC), which only CloseHand and
            OpenHand remedy. HandError says which
   ENOENT, EACCES, ETIMEDOUT and other errnos of a port or link: the port is not there yet, the board
            does not answer, or the servo does not run. Call again

 Threads: any.

 Example:

     while (RecoverHand(1) != 0) {
         fprintf(stderr, "%s\n", HandError());
         sleep(1);
     }
 */
int RecoverHand(int);

/*
 InstallReflex - let a finger react by itself

     int InstallReflex(int i, const struct Reflex *Reflex);

   i        finger, 1 to 3
   Reflex   the rule; set Reflex->Size before the call

 The servo evaluates the rules of a finger in every cycle while the finger is a spring. If the
 condition becomes true, the command changes within two cycles, or within three cycles for
 WHEN_OTHER_FINGER. At most one rule reacts in a cycle; the others wait. Each reaction is an event
 EVENT_REFLEX_FIRED with the number of the rule.

 A reaction replaces the set point. A path ends. Set points that were sent before are discarded, and
 later calls that change a part of a set point start from the new one. The next SendPos moves the
 finger again; Inhibition delays that. A rule stays until RemoveReflex or CloseHand.

 Returns the number of the rule, above 0, or -1 with
   EPERM    forked child
   EFAULT   Reflex is null
   ENODEV   no hand is open
   EINVAL   Size is too small; no such finger, joint, condition, reaction or event; Pos or Kx is NaN
   ERANGE   another value is NaN or outside its range; Pos as in SendPos; Kx as in SendKx
   EDOM     Kx as in SendKx
   ENOSPC   the finger has 16 rules

 Threads: any. Never waits for a servo. Takes a few us.

 Example, a guarded move:

     static struct Reflex Guard;

     Guard.Size = sizeof Guard;
     Guard.Condition = WHEN_EVENT;
     Guard.Event = EVENT_CONTACT;
     Guard.Reaction = THEN_HOLD;
     if (InstallReflex(1, &Guard) < 0)
         puts(HandError());
 */
int InstallReflex(int, const struct Reflex *);

/*
 RemoveReflex - remove a rule

     int RemoveReflex(int i, int Number);

   i        finger, 1 to 3
   Number   number of the rule, from InstallReflex; 0 for all rules of the finger

 Returns 0, or -1 with
   EPERM    forked child
   ENODEV   no hand is open
   EINVAL   no such finger
   ENOENT   the finger has no rule with this number

 Threads: any. Never waits for a servo. Takes a few us.

 Example:

     RemoveReflex(1, 0);
 */
int RemoveReflex(int, int);

/*
 NextEvent - take the next event

     int NextEvent(struct Event *Event);

   Event    result; set Event->Size before the call

 Takes the earliest event of all fingers since OpenHand that no call has taken yet. Events come in
 the order of their times, except if a servo is late by more than two periods. Each finger keeps its
 newest 4096 events. If they are not taken in time, the oldest are lost, and Event->Lost counts them.
 A callback of OnEvent takes nothing away from this call.

 Returns 1 if there was an event, 0 if there was none, or -1 with
   EPERM    forked child
   EFAULT   Event is null
   ENODEV   no hand is open
   EINVAL   Size is too small

 Threads: any; each event goes to one thread. Never waits for a servo.

 Example:

     struct Event Event;
     Event.Size = sizeof Event;
     while (NextEvent(&Event) == 1)
         if (Event.Kind == EVENT_SETTLED)
             printf("finger %d rests at %.2f s\n", Event.Finger, Event.Time);
 */
int NextEvent(struct Event *);

/*
 WaitEvent - wait for the next event

     int WaitEvent(struct Event *Event, int Milliseconds);

   Event         result; set Event->Size before the call
   Milliseconds  longest wait; 0: no wait; negative: no limit

 Takes an event as NextEvent does, and waits for one if there is none. CloseHand ends the wait.

 Returns 1 if there was an event, 0 if there was none within the time, or -1 with
   EPERM    forked child
   EFAULT   Event is null
   ENODEV   no hand is open, or it was closed meanwhile
   EINVAL   Size is too small

 Threads: any; each event goes to one thread. Several threads may wait.

 Example, until finger 1 has settled:

     double Pos[3] = {0.0, 0.5, 0.8};
     struct Event Event;
     Event.Size = sizeof Event;
     SendPos(1, Pos);
     while (WaitEvent(&Event, 5000) == 1)
         if (Event.Finger == 1 && Event.Kind == EVENT_SETTLED)
             break;
 */
int WaitEvent(struct Event *, int);

/*
 OnEvent - call a function with each event

     int OnEvent(void (*)(const struct Event *Event, void *Context), void *Context);

   Callback   function to call, or null for none
   Context    second argument of each call of the function

 From now on a thread of the library, which is not real-time, calls Callback with each event. There
 is one callback for the hand; a later OnEvent replaces it. While Callback runs, later events wait.
 Callback may make every call, and must return: no longjmp, pthread_exit or exception.

 When OnEvent or CloseHand has returned, the previous callback is not running and is not called
 again. If they are called by the callback itself, they do not wait for it, and it is not called
 again after it has returned.

 Returns 0, or -1 with
   EPERM    forked child
   ENODEV   no hand is open
   EAGAIN   the system refuses to start a thread

 Threads: any, and Callback. Waits until the previous callback has returned.

 Example:

     static void OnContact(const struct Event *Event, void *Context)
     {
         (void)Context;
         if (Event->Kind == EVENT_CONTACT)
             printf("finger %d touches something\n", Event->Finger);
     }

     OnEvent(OnContact, NULL);
 */
int OnEvent(void (*)(const struct Event*, void*), void *);

/*
 EventDescriptor - a descriptor for poll and select

     int EventDescriptor(void);

 The descriptor is readable while NextEvent would return an event, and when the hand is closed.
 NextEvent makes it unreadable when it returns 0, so call NextEvent until it returns 0 after each
 poll. Do not read, write or close the descriptor. CloseHand closes it.

 Returns the descriptor, the same one until CloseHand, or -1 with
   EPERM    forked child
   ENODEV   no hand is open
   EMFILE, ENFILE, EAGAIN ...  the system refuses the descriptor or the thread

 Threads: any.

 Example:

     struct pollfd Ready;
     struct Event Event;
     Ready.fd = EventDescriptor();
     Ready.events = POLLIN;
     Event.Size = sizeof Event;
     while (poll(&Ready, 1, 1000) == 1)
         while (NextEvent(&Event) == 1)
             printf("event %d\n", Event.Kind);
 */
int EventDescriptor(void);


/* These do not compile if the compiler lays out structs differently than the library. */
#ifdef __LP64__
typedef char Sun2XpFingerStatusSize[sizeof(struct FingerStatus) == 120 ? 1 : -1];
typedef char Sun2XpFingerTimingSize[sizeof(struct FingerTiming) == 120 ? 1 : -1];
typedef char Sun2XpFingerTipSize[sizeof(struct FingerTip) == 200 ? 1 : -1];
typedef char Sun2XpFingerCommandSize[sizeof(struct FingerCommand) == 40 ? 1 : -1];
typedef char Sun2XpObjectStateSize[sizeof(struct ObjectState) == 232 ? 1 : -1];
typedef char Sun2XpFingerTouchSize[sizeof(struct FingerTouch) == 32 ? 1 : -1];
typedef char Sun2XpJointTorquesSize[sizeof(struct JointTorques) == 56 ? 1 : -1];
typedef char Sun2XpPalmPoseSize[sizeof(struct PalmPose) == 200 ? 1 : -1];
typedef char Sun2XpPathPoseSize[sizeof(struct PathPose) == 48 ? 1 : -1];
typedef char Sun2XpFingerRecordSize[sizeof(struct FingerRecord) == 200 ? 1 : -1];
typedef char Sun2XpFaultSize[sizeof(struct Fault) == 48 ? 1 : -1];
typedef char Sun2XpReflexSize[sizeof(struct Reflex) == 168 ? 1 : -1];
typedef char Sun2XpEventSize[sizeof(struct Event) == 72 ? 1 : -1];
#endif

#endif /* SUN2XP_FIVE_CALLS */

#ifdef __cplusplus
}
#endif

#if defined(__clang__) || defined(__GNUC__)
#pragma pack(pop)
#endif


/* The rest of this file chooses between float and double (chapter 4). */

#if defined(SUN2XP_REAL)

#ifdef SUN2XP_REAL_DOUBLE
#define SendPos SendPosD
#define SendKx SendKxD
#define GetPos GetPosD
#endif

#elif defined(__cplusplus)

/* These are templates, because NULL and 0 would match two overloads for pointers. NULL and 0 match no template, so the
   compiler calls the plain function, which refuses them. The block is extern "C++", because a planner may include this
   header inside its own extern "C". */
extern "C++" {

inline int Sun2XpSendPos(int Sun2XpFinger, const float *Sun2XpArray) { return ::SendPos(Sun2XpFinger, Sun2XpArray); }
inline int Sun2XpSendPos(int Sun2XpFinger, const double *Sun2XpArray) { return ::SendPosD(Sun2XpFinger, Sun2XpArray); }
inline int Sun2XpSendKx(int Sun2XpFinger, const float *Sun2XpArray) { return ::SendKx(Sun2XpFinger, Sun2XpArray); }
inline int Sun2XpSendKx(int Sun2XpFinger, const double *Sun2XpArray) { return ::SendKxD(Sun2XpFinger, Sun2XpArray); }
inline int Sun2XpGetPos(int Sun2XpFinger, float *Sun2XpArray) { return ::GetPos(Sun2XpFinger, Sun2XpArray); }
inline int Sun2XpGetPos(int Sun2XpFinger, double *Sun2XpArray) { return ::GetPosD(Sun2XpFinger, Sun2XpArray); }

template <class Sun2XpElement> inline int SendPos(int Sun2XpFinger, Sun2XpElement *Sun2XpArray)
{
    return Sun2XpSendPos(Sun2XpFinger, Sun2XpArray);
}

template <class Sun2XpElement> inline int SendKx(int Sun2XpFinger, Sun2XpElement *Sun2XpArray)
{
    return Sun2XpSendKx(Sun2XpFinger, Sun2XpArray);
}

template <class Sun2XpElement> inline int SendKx(int Sun2XpFinger, Sun2XpElement (*Sun2XpArray)[3])
{
    return Sun2XpSendKx(Sun2XpFinger, reinterpret_cast<Sun2XpElement *>(Sun2XpArray));
}

template <class Sun2XpElement> inline int GetPos(int Sun2XpFinger, Sun2XpElement *Sun2XpArray)
{
    return Sun2XpGetPos(Sun2XpFinger, Sun2XpArray);
}

}

#else

/* SUN2XP_NO_GENERIC disables _Generic, for compilers that claim to support it but do not. */
#if defined(SUN2XP_NO_GENERIC)
#elif defined(__clang__)
#if __has_extension(c_generic_selections)
#define SUN2XP_GENERIC __extension__ _Generic
#endif
#elif defined(__GNUC__)
#if __GNUC__ > 4 || (__GNUC__ == 4 && __GNUC_MINOR__ >= 9)
#define SUN2XP_GENERIC __extension__ _Generic
#endif
#elif defined(__STDC_VERSION__)
#if __STDC_VERSION__ >= 201112L
#define SUN2XP_GENERIC _Generic
#endif
#endif

/* The macros below use these names, because a planner may have macros named like C keywords. */
typedef char Sun2XpChar;
typedef int Sun2XpInt;
typedef long Sun2XpLong;
typedef void Sun2XpVoid;
typedef const void Sun2XpVoidC;
typedef float Sun2XpFloat;
typedef const float Sun2XpFloatC;
typedef volatile float Sun2XpFloatV;
typedef const volatile float Sun2XpFloatCV;
typedef double Sun2XpDouble;
typedef const double Sun2XpDoubleC;
typedef volatile double Sun2XpDoubleV;
typedef const volatile double Sun2XpDoubleCV;

#ifdef SUN2XP_GENERIC
/* SUN2XP_TYPED converts NULL and 0 to this type. They compile, and are refused at run time. The type is incomplete, so
   no variable of a planner can have it. */
typedef struct Sun2XpNull Sun2XpNull;
/* A conditional expression has this type only if its other branch is a null pointer constant. So void * pointers and
   integers other than 0 become void *, which matches no association of SUN2XP_SEND and SUN2XP_GET. */
#define SUN2XP_NULL_POINTER(Array) \
    (1 ? _Generic(Array, Sun2XpVoid *: Array, default: (Sun2XpVoid *)0) : (Sun2XpNull *)0)
#define SUN2XP_NULL_NUMBER(Array) \
    (1 ? (Sun2XpVoid *)(Sun2XpLong)_Generic(Array, Sun2XpInt: Array, Sun2XpLong: Array, default: 0) : (Sun2XpNull *)0)
/* An array of variable length matches both Element (*)[3] and Element (*)[9], so one list must not contain both. */
#define SUN2XP_ROWS_OF_9(Element) \
    Element (*)[9]: (Element *)0, Element##C (*)[9]: (Element##C *)0, \
    Element##V (*)[9]: (Element##V *)0, Element##CV (*)[9]: (Element##CV *)0
#define SUN2XP_TYPED(Array) \
    _Generic(Array, SUN2XP_ROWS_OF_9(Sun2XpFloat), SUN2XP_ROWS_OF_9(Sun2XpDouble), \
        Sun2XpVoid *: SUN2XP_NULL_POINTER(Array), \
        Sun2XpInt: SUN2XP_NULL_NUMBER(Array), Sun2XpLong: SUN2XP_NULL_NUMBER(Array), default: Array)
#define SUN2XP_POINTERS(Element, Call) Element *: Call, Element (*)[3]: Call, Element (*)[3][3]: Call
#define SUN2XP_SEND(Single, Double, Finger, Array) \
    (SUN2XP_GENERIC(SUN2XP_TYPED(Array), \
        SUN2XP_POINTERS(Sun2XpFloat, Single), SUN2XP_POINTERS(Sun2XpFloatC, Single), \
        SUN2XP_POINTERS(Sun2XpFloatV, Single), SUN2XP_POINTERS(Sun2XpFloatCV, Single), \
        SUN2XP_POINTERS(Sun2XpDouble, Double), SUN2XP_POINTERS(Sun2XpDoubleC, Double), \
        SUN2XP_POINTERS(Sun2XpDoubleV, Double), SUN2XP_POINTERS(Sun2XpDoubleCV, Double), \
        Sun2XpNull *: Single)((Finger), (Sun2XpVoidC *)Array))
#define SUN2XP_GET(Single, Double, Finger, Array) \
    (SUN2XP_GENERIC(SUN2XP_TYPED(Array), \
        SUN2XP_POINTERS(Sun2XpFloat, Single), SUN2XP_POINTERS(Sun2XpFloatV, Single), \
        SUN2XP_POINTERS(Sun2XpDouble, Double), SUN2XP_POINTERS(Sun2XpDoubleV, Double), \
        Sun2XpNull *: Single)((Finger), (Sun2XpVoid *)Array))
#else
/* float, float[3], float[9] have 4, 12, 36 bytes; double, double[3], double[9] have 8, 24, 72. If the size is not a
   multiple of the size of a float (some compilers give void the size 1), the type char[-1] does not compile. */
#define SUN2XP_IS_FLOAT(Array) \
    (sizeof *Array % sizeof(Sun2XpDouble) + 0 * sizeof(Sun2XpChar[sizeof *Array % sizeof(Sun2XpFloat) ? -1 : 1]))
#define SUN2XP_SEND(Single, Double, Finger, Array) \
    (SUN2XP_IS_FLOAT(Array) ? Single((Finger), (Sun2XpVoidC *)Array) : Double((Finger), (Sun2XpVoidC *)Array))
#define SUN2XP_GET(Single, Double, Finger, Array) \
    (SUN2XP_IS_FLOAT(Array) ? Single((Finger), (Sun2XpVoid *)Array) : Double((Finger), (Sun2XpVoid *)Array))
#endif

/* From C99 on the array may be a compound literal. Its commas separate macro arguments, so the macros are variadic. */
#if defined(__STDC_VERSION__) && __STDC_VERSION__ >= 199901L
#define SendPos(Finger, ...) SUN2XP_SEND(SendPos, SendPosD, Finger, (__VA_ARGS__))
#define SendKx(Finger, ...) SUN2XP_SEND(SendKx, SendKxD, Finger, (__VA_ARGS__))
#define GetPos(Finger, ...) SUN2XP_GET(GetPos, GetPosD, Finger, (__VA_ARGS__))
#else
#define SendPos(Finger, Pos) SUN2XP_SEND(SendPos, SendPosD, Finger, (Pos))
#define SendKx(Finger, Kx) SUN2XP_SEND(SendKx, SendKxD, Finger, (Kx))
#define GetPos(Finger, Pos) SUN2XP_GET(GetPos, GetPosD, Finger, (Pos))
#endif

#endif

#ifdef SUN2XP_SETS_MACROS_ASIDE
_Pragma("pop_macro(\"AdjustFinger\")") _Pragma("pop_macro(\"Answered\")") _Pragma("pop_macro(\"Base\")")
_Pragma("pop_macro(\"Bound\")") _Pragma("pop_macro(\"Calibration\")") _Pragma("pop_macro(\"CloseHand\")")
_Pragma("pop_macro(\"Commanded\")") _Pragma("pop_macro(\"Computed\")") _Pragma("pop_macro(\"Condition\")")
_Pragma("pop_macro(\"Contact\")") _Pragma("pop_macro(\"CorruptReplies\")") _Pragma("pop_macro(\"Count\")")
_Pragma("pop_macro(\"Cycle\")") _Pragma("pop_macro(\"Cycles\")") _Pragma("pop_macro(\"DamagedFrames\")")
_Pragma("pop_macro(\"Damping\")") _Pragma("pop_macro(\"DuplicateReplies\")") _Pragma("pop_macro(\"Event\")")
_Pragma("pop_macro(\"EventDescriptor\")") _Pragma("pop_macro(\"Fault\")") _Pragma("pop_macro(\"FaultText\")")
_Pragma("pop_macro(\"Felt\")") _Pragma("pop_macro(\"FindPos\")") _Pragma("pop_macro(\"FindTip\")")
_Pragma("pop_macro(\"Finger\")") _Pragma("pop_macro(\"FingerCommand\")") _Pragma("pop_macro(\"FingerRecord\")")
_Pragma("pop_macro(\"FingerStatus\")") _Pragma("pop_macro(\"FingerTiming\")") _Pragma("pop_macro(\"FingerTip\")")
_Pragma("pop_macro(\"FingerTouch\")") _Pragma("pop_macro(\"Follows\")") _Pragma("pop_macro(\"Force\")")
_Pragma("pop_macro(\"ForeignFrames\")") _Pragma("pop_macro(\"GetFault\")") _Pragma("pop_macro(\"GetJacobian\")")
_Pragma("pop_macro(\"GetJointTorques\")") _Pragma("pop_macro(\"GetObject\")") _Pragma("pop_macro(\"GetPalmPose\")")
_Pragma("pop_macro(\"GetRecord\")") _Pragma("pop_macro(\"GetStatus\")") _Pragma("pop_macro(\"GetTiming\")")
_Pragma("pop_macro(\"GetTip\")") _Pragma("pop_macro(\"GetTouch\")") _Pragma("pop_macro(\"HandError\")")
_Pragma("pop_macro(\"IdentifyFinger\")") _Pragma("pop_macro(\"Inhibition\")") _Pragma("pop_macro(\"InstallReflex\")")
_Pragma("pop_macro(\"IsTip\")") _Pragma("pop_macro(\"Joint\")") _Pragma("pop_macro(\"JointTorques\")")
_Pragma("pop_macro(\"Kind\")") _Pragma("pop_macro(\"Kx\")") _Pragma("pop_macro(\"LateReplies\")")
_Pragma("pop_macro(\"Lost\")") _Pragma("pop_macro(\"LostEvents\")") _Pragma("pop_macro(\"LostReplies\")")
_Pragma("pop_macro(\"Maximum\")") _Pragma("pop_macro(\"Measured\")") _Pragma("pop_macro(\"MeasuredRate\")")
_Pragma("pop_macro(\"Median\")") _Pragma("pop_macro(\"MemoryLocked\")") _Pragma("pop_macro(\"Minimum\")")
_Pragma("pop_macro(\"Most\")") _Pragma("pop_macro(\"Newest\")") _Pragma("pop_macro(\"NextEvent\")")
_Pragma("pop_macro(\"Number\")") _Pragma("pop_macro(\"ObjectState\")") _Pragma("pop_macro(\"Oldest\")")
_Pragma("pop_macro(\"OnCore\")") _Pragma("pop_macro(\"OnEvent\")") _Pragma("pop_macro(\"OpenHand\")")
_Pragma("pop_macro(\"Overruns\")") _Pragma("pop_macro(\"P99\")") _Pragma("pop_macro(\"P999\")")
_Pragma("pop_macro(\"PalmPose\")") _Pragma("pop_macro(\"Part\")") _Pragma("pop_macro(\"PathPose\")")
_Pragma("pop_macro(\"Place\")") _Pragma("pop_macro(\"Pos\")") _Pragma("pop_macro(\"PosSent\")")
_Pragma("pop_macro(\"Position\")") _Pragma("pop_macro(\"Pressed\")") _Pragma("pop_macro(\"Priority\")")
_Pragma("pop_macro(\"PushFinger\")") _Pragma("pop_macro(\"Rate\")") _Pragma("pop_macro(\"Reaction\")")
_Pragma("pop_macro(\"Realtime\")") _Pragma("pop_macro(\"RecoverHand\")") _Pragma("pop_macro(\"Reflex\")")
_Pragma("pop_macro(\"Refractory\")") _Pragma("pop_macro(\"RemoveReflex\")") _Pragma("pop_macro(\"Reserved\")")
_Pragma("pop_macro(\"ResetTiming\")") _Pragma("pop_macro(\"Rotation\")") _Pragma("pop_macro(\"SendContact\")")
_Pragma("pop_macro(\"SendDamping\")") _Pragma("pop_macro(\"SendGroup\")") _Pragma("pop_macro(\"SendJointStiffness\")")
_Pragma("pop_macro(\"SendJointTorque\")") _Pragma("pop_macro(\"SendPath\")") _Pragma("pop_macro(\"SendPosFor\")")
_Pragma("pop_macro(\"SendTip\")") _Pragma("pop_macro(\"SetGravity\")") _Pragma("pop_macro(\"Size\")")
_Pragma("pop_macro(\"SkippedPeriods\")") _Pragma("pop_macro(\"Slide\")") _Pragma("pop_macro(\"Spin\")")
_Pragma("pop_macro(\"Stage\")") _Pragma("pop_macro(\"State\")") _Pragma("pop_macro(\"StatusBits\")")
_Pragma("pop_macro(\"Stiffness\")") _Pragma("pop_macro(\"StiffnessScale\")") _Pragma("pop_macro(\"StopFinger\")")
_Pragma("pop_macro(\"StopHand\")") _Pragma("pop_macro(\"TareTouch\")") _Pragma("pop_macro(\"Tension\")")
_Pragma("pop_macro(\"TensionSent\")") _Pragma("pop_macro(\"Tensions\")") _Pragma("pop_macro(\"Time\")")
_Pragma("pop_macro(\"Tip\")") _Pragma("pop_macro(\"TipRotation\")") _Pragma("pop_macro(\"Torque\")")
_Pragma("pop_macro(\"TorqueScale\")") _Pragma("pop_macro(\"Touching\")") _Pragma("pop_macro(\"Unused\")")
_Pragma("pop_macro(\"Valid\")") _Pragma("pop_macro(\"Value\")") _Pragma("pop_macro(\"Values\")")
_Pragma("pop_macro(\"Velocity\")") _Pragma("pop_macro(\"WaitEvent\")") _Pragma("pop_macro(\"WaitFingers\")")
_Pragma("pop_macro(\"WakeUp99\")") _Pragma("pop_macro(\"WakeUpMaximum\")") _Pragma("pop_macro(\"WakeUpMedian\")")
_Pragma("pop_macro(\"Warning\")") _Pragma("pop_macro(\"WarningPart\")") _Pragma("pop_macro(\"WarningValue\")")
_Pragma("pop_macro(\"Warnings\")") _Pragma("pop_macro(\"WriteBlackBox\")") _Pragma("pop_macro(\"ZeroFinger\")")
_Pragma("pop_macro(\"char\")") _Pragma("pop_macro(\"class\")") _Pragma("pop_macro(\"const\")")
_Pragma("pop_macro(\"double\")") _Pragma("pop_macro(\"extern\")") _Pragma("pop_macro(\"float\")")
_Pragma("pop_macro(\"inline\")") _Pragma("pop_macro(\"int\")") _Pragma("pop_macro(\"long\")")
_Pragma("pop_macro(\"reinterpret_cast\")") _Pragma("pop_macro(\"return\")") _Pragma("pop_macro(\"sizeof\")")
_Pragma("pop_macro(\"struct\")") _Pragma("pop_macro(\"template\")") _Pragma("pop_macro(\"typedef\")")
_Pragma("pop_macro(\"unsigned\")") _Pragma("pop_macro(\"void\")") _Pragma("pop_macro(\"volatile\")")
#endif

#endif
