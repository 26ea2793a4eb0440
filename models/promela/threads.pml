/* The threads of the library other than the servos. */

/* `write` in src/hand/dispatcher/collecting.rs: takes as long as a disk takes. */
proctype Writer()
{
    writers--
}

/* `collect` in src/hand/dispatcher/collecting.rs. */
proctype Collector()
{
    byte f;
    bool ended;
    do
    :: over -> goto done
    :: !over && (stop_collector || fault_recorded[0] || fault_recorded[1]) ->
       ended = stop_collector;
       for (f : 0 .. FINGERS - 1) {
           lock(collected[f]);
           atomic {
               if
               :: fault_recorded[f] -> fault_recorded[f] = false; writers++; run Writer()
               :: else
               fi;
               unlock(collected[f])
           }
       };
       if
       :: ended -> break
       :: else
       fi
    od;
    writers == 0 || over;
done:
    collector_runs = false
}

/* PortRepair::take_link in src/hand/port_repair.rs. */
inline take_link(p) {
    if
    :: released[p] -> released[p] = false; have_link[p] = true; checked[p] = false
    :: else
    fi
}

/* `reconnect` in src/hand/reconnection.rs: the thread that reopens ports. A failed attempt is repeated; the model
 * repeats it once. */
proctype Ports()
{
    byte p, attempts = 2;
    do
    :: stop_ports || over -> break
    :: !stop_ports && attempts > 0 && (released[0] || released[PORTS - 1]) ->
       attempts--;
       for (p : 0 .. PORTS - 1) {
           lock(repair[p]);
           atomic {
               if
               :: !repair_gone[p] && !servo_dropped[p] -> take_link(p)
               :: else
               fi
           };
           atomic {
               if
               :: have_link[p] && !checked[p] && !servo_dropped[p] && !repair_gone[p] -> checked[p] = true
               :: true
               fi;
               unlock(repair[p])
           }
       }
    od;
    ports_run = false
}

/* Drop of Hand, of Recovery and of Dispatcher in src/hand/root.rs, reconnection.rs and dispatcher.rs. */
inline drop_hand() {
    for (i : 0 .. FINGERS - 1) { closing[i] = true };
    for (i : 0 .. PORTS - 1) {
        !servo_runs[i] || over;
        servo_dropped[i] = true
    };
#ifdef MUTANT_RECOVERY_JOINS_UNDER_LOCK
    for (i : 0 .. PORTS - 1) { lock(repair[i]) };
#endif
    stop_ports = true;
    !ports_run || over;
    for (i : 0 .. PORTS - 1) {
#ifndef MUTANT_RECOVERY_JOINS_UNDER_LOCK
        lock(repair[i]);
#endif
        repair_gone[i] = true;
        unlock(repair[i])
    };
#ifndef MUTANT_COLLECTOR_IS_NOT_STOPPED
    stop_collector = true;
#endif
    !collector_runs || over;
    assert(over || (writers == 0 && !servo_runs[0] && !servo_runs[PORTS - 1]));
    /* Every motor is in its end state. */
    for (i : 0 .. FINGERS - 1) { assert(over || !begun || own[i].stage == CLOSED || own[i].stage == FAULTED) };
    i = 0
}

/* A new hand before its threads start: `reach` in src/hand/opening.rs. */
inline new_hand() {
    generation++;
    for (i : 0 .. FINGERS - 1) {
        own[i].stage = OPENING; own[i].verdict = NONE; own[i].orders = 0; own[i].recoveries = 0;
        report[i].stage = OPENING; report[i].verdict = NONE; report[i].orders = 0; report[i].recoveries = 0;
        order[i] = NOTHING; ordered[i] = 0; closing[i] = false; claimed[i] = false;
        calls_seen[i] = stop_calls; faults_seen[i] = shared_faults; stops_sent[i] = false; fault_recorded[i] = false;
        restored[i] = false; repairs[i] = 0
    };
    for (i : 0 .. PORTS - 1) {
        released[i] = false; repaired[i] = false; link_held[i] = true; servo_dropped[i] = false;
        repair_gone[i] = false; have_link[i] = false; checked[i] = false
    };
    ready = 0; begun = false; begin_dropped = false; stop_collector = false; stop_ports = false;
    i = 0
}

#define HOLDS_POSE(f) (report[f].stage != OPENING && report[f].stage != FAULTED)

/* `open` in src/capi/hand_table.rs, Hand::open_from in src/hand/root.rs, `start` in src/hand/servo_threads.rs. */
proctype Opener()
{
    byte i;
    atomic {
        if
        :: exiting || over || lifecycle -> goto refused         /* try_lock */
        :: else -> lifecycle = true
        fi
    };
    atomic {
        !hand.writer || over;
        if
        :: open_hand -> goto opened
        :: else
        fi;
        new_hand();
        collector_runs = true;
        run Collector()
    };
    atomic { servo_runs[0] = true; run Servo(0) };
#if PORTS == 2
    if
    :: atomic { servo_runs[1] = true; run Servo(1) }
    :: goto failed                          /* the system refuses a thread */
    fi;
#endif
    ready == PORTS || over;
    if
    :: begun = true
    :: goto failed                          /* real time is enforced and not permitted */
    fi;
    /* wait_for_every_finger */
    do
    :: over -> goto failed
    :: report[0].stage == FAULTED || report[1].stage == FAULTED -> goto failed
    :: HOLDS_POSE(0) && HOLDS_POSE(1) -> break
    od;
#ifndef NO_RECONNECT
    atomic { ports_run = true; run Ports() };                   /* finger.reconnect */
#endif
    if
    :: exiting -> goto failed
    :: else
    fi;
    write(hand);
    atomic { open_hand = true; unwrite(hand) };
    goto opened;
failed:
#ifndef MUTANT_BEGIN_STAYS_OPEN
    begin_dropped = true;
#endif
    drop_hand();
opened:
    unlock(lifecycle);
refused:
    callers--
}

/* `close` in src/capi/hand_table.rs. */
inline close_hand() {
    lock(lifecycle);
    write(hand);
    atomic { was_open = open_hand; open_hand = false; unwrite(hand) };
    if
    :: was_open -> drop_hand()
    :: else
    fi;
    unlock(lifecycle)
}
