/* The calls of the planner. Each process is one call in a thread of its own. */

#define CLOSED_MEANWHILE (!open_hand || exiting || over)

/* Statements under locks are one step, because they wait only for the locks. With -DCALLS they are separate steps, so
 * that a thread can hold some locks while another thread takes others. */
#ifdef CALLS
#define SECTION
#else
#define SECTION atomic
#endif

inline read_hand() {
    !hand.writer || over;
    hand.readers++
}

proctype Closer()
{
    byte i;
    bool was_open;
    close_hand();
    callers--
}

/* sun2xp_stop_all: stop_all in src/finger/stop_signal.rs. */
proctype Stopper()
{
    stop_calls++;
    callers--
}

/* Mailbox::order and Mailbox::restart in src/finger/mailbox.rs. */
inline give_order(f, what) {
    given = false;
    if
    :: (report[f].stage == RUNNING || report[f].stage == LIMP) && report[f].orders == ordered[f] ->
       ordered[f]++;
       my_order = ordered[f];
       order[f] = what;
       given = true
    :: else
    fi
}

#define OTHER_STAGE(f) (report[f].stage != seen.stage || report[f].verdict != seen.verdict)
#define OTHER_REPORT(f) (OTHER_STAGE(f) || report[f].orders != seen.orders || report[f].recoveries != seen.recoveries)

/* Calibrating in src/hand/calibrating.rs, and `calibrate` in src/capi/hand_table.rs. */
proctype Calibrator(byte f)
{
    byte mine, now, my_order, recoveries;
    bool given, found, limited;
    Report seen;
    /* Calibrating::begin */
    atomic { read_hand(); mine = generation };
    SECTION {
        if
        :: CLOSED_MEANWHILE || claimed[f] -> unread(hand); goto returned
        :: else -> claimed[f] = true
        fi;
        read(configuration);
        unread(configuration);
        lock(collected[f]);
        lock(planners[f]);
        recoveries = report[f].recoveries;
        give_order(f, CALIBRATE);
        unlock(planners[f]);
        unlock(collected[f]);
        unread(hand);
        if
        :: !given -> goto unclaimed
        :: else
        fi
    };
    /* Calibrating::poll */
    do
    :: atomic {
           read_hand();
           if
           :: CLOSED_MEANWHILE -> unread(hand); goto unclaimed
           :: else
           fi;
           !planners[f] || over;
           now = generation;
           seen.stage = report[f].stage; seen.verdict = report[f].verdict;
           seen.orders = report[f].orders; seen.recoveries = report[f].recoveries;
           limited = false;
           if
           :: seen.stage == FAULTED -> unread(hand); goto unclaimed
#ifdef MUTANT_CALIBRATION_IGNORES_RECOVERY
           :: else
#else
           :: seen.stage != FAULTED && seen.recoveries != recoveries -> unread(hand); goto unclaimed
           :: seen.stage != FAULTED && seen.recoveries == recoveries
#endif
           fi;
           if
           :: seen.orders != my_order -> limited = true
           :: seen.orders == my_order && found ->
              if
              :: seen.stage != OPENING -> unread(hand); goto unclaimed
              :: else
              fi
           :: seen.orders == my_order && !found && seen.verdict == REFUSED -> unread(hand); goto unclaimed
           :: seen.orders == my_order && !found && seen.verdict == FOUND -> goto use_result
           :: seen.orders == my_order && !found && (seen.verdict == NONE || seen.verdict == IN_PROGRESS) ->
#ifdef MUTANT_CALIBRATION_IGNORES_RECOVERY
              skip
#else
              if
              :: seen.stage != CALIBRATING -> unread(hand); goto unclaimed
              :: else
              fi
#endif
           fi;
           unread(hand)
       };
wait_for_change:
       if
       :: limited -> goto unclaimed                             /* time limit */
       :: CLOSED_MEANWHILE || now != generation || OTHER_REPORT(f)
       fi
    od;
use_result:
    SECTION {
        write(configuration);
        lock(collected[f]);
        lock(planners[f]);
        give_order(f, RESTART);
        unlock(planners[f]);
        unlock(collected[f]);
        unwrite(configuration);
        unread(hand);
        if
        :: !given -> goto unclaimed
        :: else -> found = true; goto wait_for_change
        fi
    };
unclaimed:
    atomic {
        /* The claim belongs to the hand with which the call began. */
        if
        :: mine == generation -> claimed[f] = false
        :: else
        fi;
returned:
        callers--
    }
}

/* Quick calls: the locks that each of them takes. */
proctype Commander(byte f)
{
    atomic {
        read_hand();
        if
        :: CLOSED_MEANWHILE -> goto returned
        :: else
        fi
    };
    if
    ::  /* send_position in src/hand/set_points.rs */
        read(admission[f]);
        lock(planners[f]);
        unlock(planners[f]);
        unread(admission[f])
    ::  /* adjust in src/hand/adjustment.rs */
        write(configuration);
        lock(collected[f]);
        write(admission[f]);
        lock(planners[f]);
        unlock(planners[f]);
        unwrite(admission[f]);
        unlock(collected[f]);
        unwrite(configuration)
    ::  /* losses in src/hand/dispatcher.rs */
#ifdef MUTANT_LOCKS_IN_ANY_ORDER
        lock(planners[f]);
        lock(collected[f]);
#else
        lock(collected[f]);
        lock(planners[f]);
#endif
        unlock(planners[f]);
        unlock(collected[f])
    ::  /* push_simulated in src/hand/root.rs; the board's thread takes no other lock */
        read(admission[f]);
        unread(admission[f]);
        read(configuration);
        unread(configuration)
    fi;
returned:
    atomic { unread(hand); callers-- }
}

/* send_group in src/hand/groups.rs: holds the locks of every finger of the group. */
proctype Grouper(byte first)
{
    byte second = 1 - first;
    atomic {
        read_hand();
        if
        :: CLOSED_MEANWHILE -> goto returned
        :: else
        fi
    };
    read(admission[first]);
    read(admission[second]);
    lock(planners[first]);
    lock(planners[second]);
    unlock(planners[first]);
    unlock(planners[second]);
    unread(admission[first]);
    unread(admission[second]);
returned:
    atomic { unread(hand); callers-- }
}

/* `close_at_exit` in src/capi/hand_table.rs. A signal handler may call exit. If the handler has interrupted a call in
 * the same thread, that call keeps its lock. */
proctype Exiter()
{
    byte i;
    if
    :: read(hand)
    :: skip
    fi;
    exiting = true;
#ifdef MUTANT_EXIT_WAITS_WITHOUT_LIMIT
    lock(lifecycle);
#else
    if
    :: atomic { !lifecycle -> lifecycle = true }
    :: goto exited
    fi;
#endif
    if
    :: read(hand)
    :: goto exited
    fi;
    if
    :: open_hand -> for (i : 0 .. FINGERS - 1) { closing[i] = true }
    :: else
    fi;
exited:
    over = true;
    callers--
}
