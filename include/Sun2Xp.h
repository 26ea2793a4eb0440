/* Sun2Xp.h - a three-finger tendon-driven hand as a set of springs

   GENERATED from src/capi/; do not edit. To renew it:

       SUN2XP_WRITE_HEADER=1 cargo test --test header

   A planner is a program that commands the hand. The report is COINS Technical Report 90-48 (1990), which
   describes the controller. Planners of 1990 were written for the report's controller. This file declares
   the interface of these planners: five calls and HandError. It is also the manual of this interface.
   sun2xp.h is the interface for new programs, and has all other calls. Both headers may be used together.

       1. Quick start             5. Planners of 1990
       2. Return values, errno    6. Threads, signals, fork, exit
       3. Units, frames, order    7. Configuration
       4. float and double        8. The calls


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

   Example, how to compile and run it after make install:

       cc planner.c $(pkg-config --cflags --libs sun2xp)
       ./a.out

   Angles are in rad, stiffness in N/cm. Each finger is a spring: it pulls its tip toward the pose
   sent last by SendPos, with the stiffness sent last by SendKx. Without a configuration file the
   program moves a simulated hand, and one line on standard error says so.


   2. RETURN VALUES, ERRNO

   Every call except HandError returns an int: 0 if it succeeded, -1 if it was refused. A refused call
   changes nothing. HandError() gives the cause and the remedy. errno gives the class of the refusal:

       EPERM      the process is a forked child (chapter 6)
       EFAULT     an argument is a null pointer
       ENODEV     no hand is open; for OpenHand: the board that finger.board names is not found, or is
                  found at several ports
       EBUSY      a hand is open already, or is being opened or closed
       EINVAL     no such finger; NaN or infinity; an unusable configuration
       ERANGE     angles outside the joint limits; Kx stiffer than the bound
       EDOM       Kx not symmetric, or with a negative eigenvalue
       EIO        the finger is faulted: a fault or a stop call of sun2xp.h has stopped it. CloseHand and
                  OpenHand start it again, and so does sun2xp_recover of sun2xp.h
       ESHUTDOWN  the process is exiting, and the hand is closed (chapter 6)
       others     there is not enough memory; the configuration file or a port cannot be used; or
                  hand.real_time is "enforce", and real time is not available (see OpenHand). The value is the
                  errno of the system, or the errno that describes the reason best

   If several reasons apply, a call reports the one that its entry in chapter 8 lists first. The entries list
   neither ESHUTDOWN, which comes before ENODEV, nor the ETIMEDOUT of GetPos (chapter 7). A call that
   succeeds changes neither errno nor the text of HandError(). Arrays are read and written only during the
   call. An output is written only if the call returns 0.

   Planners of 1990 ignore return values. Therefore the first refusal of each kind in a process also prints
   one line on standard error, whether or not the planner checks return values. Refusals with the same cause
   are of one kind, whatever their arguments were. The key hand.print_refusals = false (chapter 7)
   suppresses these lines for the hand that OpenHand opened last, except the line for a refusal of OpenHand.


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
   templates. Other types do not compile: cast a void * pointer to float * or double *. NULL and 0
   compile, and are refused with EFAULT. C arrays of variable length compile too. An array that is too
   short also compiles: the compiler checks at most the length of the rows of a matrix.

   The C macros are function-like, so they do not work for a planner that declares the functions
   itself or takes their addresses. Compile such a planner with the element type of all its arrays:

       -DSUN2XP_REAL=float     or      -DSUN2XP_REAL=double

   SendPos, SendKx and GetPos are then plain functions for
   that type; for double they are renamed to SendPosD, SendKxD and GetPosD. The planner's
   declarations may be int SendPos(); or those of this header. With gcc 15 or newer, int SendPos();
   also needs -std=gnu89, because it declares a function without parameters in C23, the default of that
   compiler. For any other declarations, compile instead with -DSUN2XP_H, which leaves out this header.
   For double, this also needs

       -DSendPos=SendPosD -DSendKx=SendKxD -DGetPos=GetPosD

   In the library, the symbols SendPos, SendKx and GetPos take float, and those ending in D take
   double. Compilers without _Generic (gcc before 4.9) choose by the size of an element: they treat
   an array of int as one of float, and NULL needs a cast.


   5. PLANNERS OF 1990

       #include "Sun2Xp.c"        works, also in several files of a program: it includes this header
       K&R source                 gcc -std=gnu89
       no include at all          gcc -std=gnu89, unless the planner declares all calls with their parameters.
                                  Without this option, gcc 14, clang 16 and newer versions refuse a call that
                                  is not declared, and gcc 15 refuses arguments for a function that is
                                  declared without parameters. The plain symbols take float; for double
                                  also add -DSendPos=SendPosD -DSendKx=SendKxD -DGetPos=GetPosD
       return values ignored      see the line on standard error (chapter 2)
       the planner's functions    no conflict: this header declares only OpenHand, SendPos, SendKx, GetPos,
                                  CloseHand and HandError, and SendPosD, SendKxD and GetPosD for double. The
                                  other names of the library begin with sun2xp_, Sun2Xp or SUN2XP_

   Macros: with clang, and with gcc 4.6 or newer, this header saves the planner's macros and restores
   them at its end. So a planner may have macros named i, K or Pos, and macros named like C keywords,
   such as const, volatile, int or float. The exceptions are

       SendPos, SendKx, GetPos, SendPosD, SendKxD, GetPosD
       names that begin with SUN2XP_ or Sun2Xp
       _Pragma, and names that the compiler defines itself
       _Generic, default and sizeof where a C file calls SendPos, SendKx or GetPos

   A planner must not poison a name that this header uses (#pragma GCC poison). With other
   compilers, no macro of the planner may have the name of a C keyword or of a call of this header.


   6. THREADS, SIGNALS, FORK, EXIT

   Any thread may make any call, also while other threads make calls. A signal handler must make no call
   of this header. A child that is forked after OpenHand has no hand: each call but HandError is refused
   with EPERM. When a planner exits with its hand open, the library brings the fingers to their end
   state, as CloseHand does. The servo threads block all signals and run under SCHED_FIFO if the system
   permits it. Chapters 5 and 6 of sun2xp.h have the details. sun2xp.h also has the calls for status,
   faults and everything else.


   7. CONFIGURATION

   OpenHand uses the first of these:

       1. the file that the environment variable SUN2XP_CONFIG names; it must exist. An empty
          SUN2XP_CONFIG counts as not set
       2. sun2xp.toml in the working directory
       3. sun2xp/sun2xp.toml in $XDG_CONFIG_HOME, or ~/.config
       4. sun2xp/sun2xp.toml in the folders of $XDG_CONFIG_DIRS, or /etc/xdg
       5. no file: the simulated hand, announced in one line on standard error

   The file must be a regular file of at most 1 MiB. If it names neither a port nor a board for a finger,
   the finger is simulated, and one line on standard error says so. There is no such line for a finger
   with port = "simulated". OpenHand refuses a file that names a real port or board for one finger, and
   neither of the two for another.

   If a program is setuid or setgid, or if its file has capabilities, its environment and its working
   directory belong to its caller, and the library does not trust them. It then reads only
   /etc/xdg/sun2xp/sun2xp.toml; if SUN2XP_CONFIG is set, OpenHand fails with EACCES.

   The file is TOML: [hand], [finger] for all fingers, [finger.1] to [finger.3] for one. This manual
   writes hand.rate for the key rate of [hand]. Every key has a default. An unknown key is refused, with
   file, line and reason.

   Example, sun2xp.toml:

       [hand]
       rate = 1000.0
       fingers = [1]
       [finger.1]
       port = "/dev/ttyUSB0"

   If the file has a table [remote], OpenHand opens a hand that sun2xp serve offers on another machine.
   The keys "endpoint" and "hand" of that table select the hand, for example with the values
   "tls/cell:7447" and "left" (docs/remote.md). OpenHand then needs libsun2xp_remote.so
   (docs/installation.md), and EBUSY also means that another planner commands the hand. SendPos does not
   wait for the network. GetPos is refused with ETIMEDOUT if its data are too old.


   8. THE CALLS: each call has an entry below. The examples are statements of a function in a file that
   includes stdio.h and stdlib.h. Except in the example of OpenHand, this function has opened the hand. */

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
_Pragma("push_macro(\"CloseHand\")") _Pragma("push_macro(\"HandError\")") _Pragma("push_macro(\"OpenHand\")")
_Pragma("push_macro(\"char\")") _Pragma("push_macro(\"class\")") _Pragma("push_macro(\"const\")")
_Pragma("push_macro(\"double\")") _Pragma("push_macro(\"extern\")") _Pragma("push_macro(\"float\")")
_Pragma("push_macro(\"inline\")") _Pragma("push_macro(\"int\")") _Pragma("push_macro(\"long\")")
_Pragma("push_macro(\"reinterpret_cast\")") _Pragma("push_macro(\"return\")") _Pragma("push_macro(\"sizeof\")")
_Pragma("push_macro(\"struct\")") _Pragma("push_macro(\"template\")") _Pragma("push_macro(\"typedef\")")
_Pragma("push_macro(\"void\")") _Pragma("push_macro(\"volatile\")")
#undef CloseHand
#undef HandError
#undef OpenHand
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
#undef void
#undef volatile
#endif

#ifdef __cplusplus
extern "C" {
#endif

/*
 OpenHand - start the hand

     int OpenHand(void);

 Reads the configuration (chapter 7), opens the ports, starts the servos and brings the tendons
 under tension. Returns when every finger has answered and holds its present pose at the configured
 initial stiffness. From then on GetPos is valid, and nothing moves until SendPos. Takes at most
 about a second for the simulated hand.

 Returns 0, or -1 with
   EPERM    forked child
   ENOMEM   there is not enough memory
   EBUSY    a hand is open and stays open, or another thread is opening or closing one
   ENOENT, EACCES ...  the configuration file cannot be read; errno of the system
   EINVAL   the configuration is unusable; HandError names file, line and reason
   ENOENT, EACCES, EBUSY ...  a port cannot be opened; errno of the system
   ETIMEDOUT ...  a board does not answer, or the device at the port is not a board. The errno is
            ENODEV if the board that finger.board names is not found, or is found at several ports
   EIO      the tendons of a finger do not come under tension in time, the finger faults before
            that, or the self-test finds wrong wiring (hand.self_test)
   EPERM, ENOMEM, EINVAL ...  hand.real_time is "enforce", and SCHED_FIFO, locked memory or the
            configured core is not available; HandError says what to change

 Threads: any. The calls of sun2xp.h open further hands.

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
   EBUSY    the call was made in an event callback (sun2xp_on_event) of any hand, while another thread
            was opening or closing this hand

 Threads: any. Waits for an OpenHand or CloseHand of another thread, then closes. Waits until the
 callback of this hand has returned, unless the call was made in an event callback of any hand.
 */
int CloseHand(void);

/*
 SendPos - send desired joint angles to a finger

     int SendPos(int i, const float *Pos);      also takes const double *Pos (chapter 4)

   i     finger, 1 to 3
   Pos   Pos[3]: desired angles of joints 0, 1, 2, rad (chapter 3)

 All three angles take effect together. From the next cycle on, the anchor (rest position) of the
 fingertip's spring moves to Pos, along a straight line in joint angles and at a bounded speed. The
 stiffness is the one sent last. When the anchor is at Pos, the force of the fingertip is Kx (Tip - p)
 at any distance: Tip is the position of the fingertip at the angles Pos, and p is its present
 position. With finger.controller.law = "report" the finger follows the law of the report, which holds
 for small distances. The call does not wait until the finger arrives; GetPos reads where it is. The
 limits are the configured joint limits, by default -1.0472 to 1.0472 rad for joint 0, -0.5236 to
 1.7453 rad for joint 1 and 0.0873 to 2.0944 rad for joint 2.

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
 largest eigenvalue may be at most the configured bound, by default 6 N/cm if the servo rate
 (hand.rate) is 1000 Hz or more, and 5 N/cm otherwise.

 Returns 0, or -1 with
   EPERM    forked child
   EFAULT   Kx is null
   ENODEV   no hand is open
   EINVAL   no such finger; an entry is NaN or infinite
   EDOM     Kx is not symmetric, or has a negative eigenvalue
   ERANGE   Kx is stiffer than the bound (hand.out_of_range = "clamp" clamps it instead)
   EIO      the finger is faulted
   ERANGE   Kx is too stiff for the damping ratio of sun2xp_send_damping ("clamp" clamps this ratio
            instead)

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

 While the servo thread does not run, the angles stay those of its last cycle.

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
 refused. A call that succeeds changes neither the text nor errno. So read the text only after a call
 has returned -1. The pointer is never null. Do not free the text: it belongs to the library, and is
 valid until the next refused call of the same thread.

 Threads: any; each has its own text. Works in a forked child too.
 */
const char *HandError(void);


#ifdef __cplusplus
}
#endif


/* The rest of this file chooses between float and double (chapter 4). */

#if defined(SUN2XP_REAL)

#ifdef SUN2XP_REAL_DOUBLE
#define SendPos SendPosD
#define SendKx SendKxD
#define GetPos GetPosD
#endif

#elif defined(__cplusplus)

/* SendPos, SendKx and GetPos are templates, because NULL and 0 would match two overloads for pointers. NULL and 0 match
   no template, so the compiler calls the plain function, which refuses them. The block is extern "C++", because a
   planner may include this header inside its own extern "C". */
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
/* SUN2XP_TYPED converts NULL and 0 to a pointer to this type. They compile, and are refused at run time. The type is
   incomplete, so no variable of a planner can have it. */
typedef struct Sun2XpNull Sun2XpNull;
/* A conditional expression with the branch (Sun2XpNull *)0 has the type Sun2XpNull * only if its other branch is a null
   pointer constant. So void * pointers and integers other than 0 become void *, which matches no association of
   SUN2XP_SEND and SUN2XP_GET. */
#define SUN2XP_NULL_POINTER(Array) \
    (1 ? _Generic(Array, Sun2XpVoid *: Array, default: (Sun2XpVoid *)0) : (Sun2XpNull *)0)
#define SUN2XP_NULL_NUMBER(Array) \
    (1 ? (Sun2XpVoid *)(Sun2XpLong)_Generic(Array, Sun2XpInt: Array, Sun2XpLong: Array, default: 0) : (Sun2XpNull *)0)
/* A pointer to an array of variable length matches both Element (*)[3] and Element (*)[9], so one _Generic must not
   list both. */
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
_Pragma("pop_macro(\"CloseHand\")") _Pragma("pop_macro(\"HandError\")") _Pragma("pop_macro(\"OpenHand\")")
_Pragma("pop_macro(\"char\")") _Pragma("pop_macro(\"class\")") _Pragma("pop_macro(\"const\")")
_Pragma("pop_macro(\"double\")") _Pragma("pop_macro(\"extern\")") _Pragma("pop_macro(\"float\")")
_Pragma("pop_macro(\"inline\")") _Pragma("pop_macro(\"int\")") _Pragma("pop_macro(\"long\")")
_Pragma("pop_macro(\"reinterpret_cast\")") _Pragma("pop_macro(\"return\")") _Pragma("pop_macro(\"sizeof\")")
_Pragma("pop_macro(\"struct\")") _Pragma("pop_macro(\"template\")") _Pragma("pop_macro(\"typedef\")")
_Pragma("pop_macro(\"void\")") _Pragma("pop_macro(\"volatile\")")
#endif

#endif
