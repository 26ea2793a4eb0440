/* Root, Dispatcher, servos, recovery, calibration and shutdown of a hand with two fingers. docs/deadlock.md explains
 * the model. Each process names the code that it stands for.
 *
 * A loop that polls a condition is one statement that waits for the condition, so a call that polls without end is an
 * invalid end state. A wait with a time limit may end at any time, so it never blocks. A servo waits here until it
 * has something to do, instead of beginning a cycle every period. Faults and calls are limited in number. So every run
 * ends, and every process must have terminated by then.
 *
 * The name of a scene (-DSHUTDOWN, ...) selects the threads of the planner: see `init`. -DPORTS=1 puts both fingers on
 * one port and one servo thread. -DMUTANT_... introduces a defect that must be found.
 */
#define FINGERS 2
#ifndef PORTS
#define PORTS 2
#endif
#define PORT_OF(finger) ((finger) * PORTS / FINGERS)
#define ON(port, finger) (PORT_OF(finger) == (port))

mtype:stage = { OPENING, LIMP, CALIBRATING, RUNNING, CLOSING, CLOSED, FAULTED }
mtype:order = { NOTHING, CALIBRATE, RESTART }
mtype:verdict = { NONE, IN_PROGRESS, FOUND, REFUSED }

/* src/finger/report.rs */
typedef Report {
    mtype:stage stage;
    mtype:verdict verdict;
    byte orders;
    byte recoveries
}

/* RwLock of src/realtime/locks.rs: from the first attempt of a writer on, no new reader gets the lock. */
typedef RwLock {
    byte readers;
    bool writer
}

/* The process has exited: no thread waits any more. */
bool over;

inline lock(mutex) { atomic { !mutex || over -> mutex = true } }
inline unlock(mutex) { mutex = false }
inline read(rwlock) { atomic { !rwlock.writer || over -> rwlock.readers++ } }
inline unread(rwlock) { rwlock.readers-- }
inline write(rwlock) {
    atomic { !rwlock.writer || over -> rwlock.writer = true };
    rwlock.readers == 0 || over
}
inline unwrite(rwlock) { rwlock.writer = false }

/* src/capi/hand_table.rs: LIFECYCLE, HAND and EXITING. */
bool lifecycle;
RwLock hand;
bool open_hand;
bool exiting;
/* Number of the hand: a call can begin with one hand and meet the next one. */
byte generation;

/* src/hand/root.rs and src/hand/dispatcher.rs: the locks of a hand. */
RwLock configuration;
RwLock admission[FINGERS];
bool collected[FINGERS];
bool planners[FINGERS];
bool claimed[FINGERS];

/* src/finger/mailbox.rs: both directions, without waiting. */
Report report[FINGERS];
mtype:order order[FINGERS];
byte ordered[FINGERS];
bool closing[FINGERS];

/* src/finger/stop_signal.rs */
byte stop_calls;
byte calls_seen[FINGERS];
byte shared_faults;
byte faults_seen[FINGERS];

/* The servo's own data: src/finger/servo.rs. */
Report own[FINGERS];
bool stops_sent[FINGERS];
bool fault_recorded[FINGERS];

/* src/finger/link_handover.rs: rings with one place. */
bool released[PORTS], repaired[PORTS];
/* Whether the handshake of a finger was relayed while the servo kept the link. */
bool restored[FINGERS];
bool link_held[PORTS];
bool servo_dropped[PORTS];

/* src/hand/port_repair.rs and src/hand/reconnection.rs */
bool repair[PORTS];
bool repair_gone[PORTS];
bool have_link[PORTS], checked[PORTS];
byte repairs[FINGERS];

/* src/hand/servo_threads.rs: the channels `report` and `begin`. */
byte ready;
bool begun, begin_dropped;

/* The threads that close must join. */
bool servo_runs[PORTS], collector_runs, ports_run;
byte writers;
bool stop_collector, stop_ports;

/* The environment. */
bool broken[FINGERS];
bool panics[PORTS];

/* Threads of the planner that have not ended. */
byte callers;

#define UNDER_CONTROL(f) (own[f].stage != CLOSED && own[f].stage != FAULTED)
#define FINISHED_FINGER(f) (own[f].stage == CLOSED || (own[f].stage == FAULTED && closing[f]))
#define AT_REST(f) (own[f].stage == FAULTED && stops_sent[f] && !closing[f])
#define STOP(f) (stop_calls != calls_seen[f] || shared_faults != faults_seen[f])
#define MOVES_ON(f) (own[f].stage == OPENING || own[f].stage == CALIBRATING || own[f].stage == CLOSING)
#define EVENT(f) (broken[f] || STOP(f) || order[f] != NOTHING || closing[f])
#define BUSY(f) ((UNDER_CONTROL(f) && (MOVES_ON(f) || EVENT(f))) || (own[f].stage == FAULTED && !stops_sent[f]))
#define FOR_ALL(p, what) ((!ON(p, 0) || what(0)) && (!ON(p, 1) || what(1)))
#define FOR_ONE(p, what) ((ON(p, 0) && what(0)) || (ON(p, 1) && what(1)))
#define FINISHED(p) FOR_ALL(p, FINISHED_FINGER)
#define RELEASES(p) (link_held[p] && FOR_ALL(p, AT_REST))
#define RESTORED(f) (restored[f])
#define TAKES(p) (link_held[p] && FOR_ONE(p, RESTORED))
#define WORK(p) (FOR_ONE(p, BUSY) || RELEASES(p) || repaired[p] || TAKES(p))

#include "servo.pml"
#include "threads.pml"
#include "calls.pml"
#include "recovery.pml"
#include "scenes.pml"
