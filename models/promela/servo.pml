/* The servo threads. */

#ifdef MUTANT_SERVO_WAITS_FOR_PLANNER
chan results = [0] of { bit };
#endif

/* FingerServo::fault in src/finger/servo.rs, and StopSignal::raise. */
inline fault(f, raised) {
    own[f].stage = FAULTED;
    stops_sent[f] = false;
    fault_recorded[f] = true;
#ifdef TOGETHER
    if
    :: raised -> shared_faults++
    :: else
    fi
#endif
}

/* FingerServo::recover in src/finger/servo/life.rs. An order that was not taken is discarded. */
inline recover_finger(f) {
    calls_seen[f] = stop_calls;
    faults_seen[f] = shared_faults;
    own[f].recoveries++;
    if
    :: order[f] != NOTHING -> own[f].orders++; order[f] = NOTHING
    :: else
    fi;
    own[f].stage = OPENING
}

/* ServedPort::exchange in src/finger/servo_thread.rs. */
inline exchange(p) {
    for (f : 0 .. FINGERS - 1) {
        if
        :: ON(p, f) && link_held[p] && restored[f] ->
           restored[f] = false;
           assert(AT_REST(f) || closing[f]);
           if
           :: AT_REST(f) -> recover_finger(f)
           :: else
           fi
        :: else
        fi
    };
    if
    :: RELEASES(p) ->
       assert(!released[p]);
       link_held[p] = false;
       released[p] = true
    :: !RELEASES(p) && repaired[p] ->
       repaired[p] = false;
       link_held[p] = true;
       for (f : 0 .. FINGERS - 1) {
           if
           :: ON(p, f) -> restored[f] = false; recover_finger(f)
           :: else
           fi
       }
    :: else
    fi
}

/* FingerServo::control in src/finger/servo/control.rs: an order, a request to close, or the next step of the stage. */
inline control(f) {
    if
    :: STOP(f) -> fault(f, false)
    :: !STOP(f) && broken[f] -> broken[f] = false; fault(f, true)
    :: else ->
       if
       :: order[f] == CALIBRATE ->
          own[f].orders++; own[f].verdict = IN_PROGRESS; own[f].stage = CALIBRATING; order[f] = NOTHING
       :: order[f] == RESTART -> own[f].orders++; own[f].stage = OPENING; order[f] = NOTHING
       :: order[f] == NOTHING && own[f].stage == OPENING -> own[f].stage = RUNNING
       :: order[f] == NOTHING && own[f].stage == CALIBRATING ->
          if
          :: own[f].verdict = FOUND
          :: own[f].verdict = REFUSED
          fi;
          own[f].stage = LIMP
       :: order[f] == NOTHING && own[f].stage == CLOSING -> own[f].stage = CLOSED
       :: else
       fi;
       if
       :: closing[f] && UNDER_CONTROL(f) && own[f].stage != CLOSING -> own[f].stage = CLOSING
       :: else
       fi
    fi
}

inline publish(f) {
    report[f].stage = own[f].stage;
    report[f].verdict = own[f].verdict;
    report[f].orders = own[f].orders;
    report[f].recoveries = own[f].recoveries
}

/* `run` in src/hand/servo_threads.rs, and Servo::run in src/finger/servo_thread.rs. A period is two steps, between
 * which other threads run. */
proctype Servo(byte p)
{
    byte f;
    ready++;
    begun || begin_dropped || over;
    if
    :: !begun -> goto ended
    :: else
    fi;
    do
    :: over -> break
#ifdef MUTANT_FAULTED_IS_NOT_FINISHED
    :: atomic { FINISHED(p) && own[0].stage != FAULTED && own[1].stage != FAULTED -> break }
#else
    :: atomic { FINISHED(p) -> break }
#endif
    :: atomic {
           /* A panic: Servo::fail drops the handover and faults every finger. The thread ends. */
           panics[p] && !FINISHED(p) ->
           panics[p] = false;
           servo_dropped[p] = true;
           for (f : 0 .. FINGERS - 1) {
               if
               :: ON(p, f) && UNDER_CONTROL(f) -> fault(f, true); publish(f)
               :: else
               fi
           };
           break
       }
    :: d_step { WORK(p) && !FINISHED(p) && !panics[p] -> exchange(p); f = 0 };
       atomic {
           for (f : 0 .. FINGERS - 1) {
               if
               :: ON(p, f) && UNDER_CONTROL(f) -> control(f)
               :: ON(p, f) && own[f].stage == FAULTED -> stops_sent[f] = true
               :: else
               fi;
               if
               :: ON(p, f) -> publish(f)
               :: else
               fi
           };
           f = 0
       }
#ifdef MUTANT_SERVO_WAITS_FOR_PLANNER
       /* The report is a message on a synchronous channel. */
       results ! 0
#endif
    od;
ended:
    servo_runs[p] = false
}
