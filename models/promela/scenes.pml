/* The planner's threads. Every scene ends with CloseHand, after all other calls have returned. */

init {
    byte i;
    bool was_open;
#ifdef OPENED
    atomic { callers = 1; run Opener() };
    callers == 0;
#endif
    atomic {
#ifdef SHUTDOWN
        /* Two threads shut down while the hand opens, during sun2xp_stop_all and a fault. */
        callers = 4;
        run Opener(); run Closer(); run Closer(); run Stopper();
        broken[0] = true
#endif
#ifdef RECOVERY
        /* Shutdown while a finger recovers, and faults again. */
        callers = 3;
        run Recoverer(0); run Closer(); run Stopper();
        broken[0] = true
#endif
#ifdef TWO_RECOVERIES
        /* Two threads recover fingers of the hand. */
        callers = 3;
        run Recoverer(0); run Recoverer(1); run Stopper()
#endif
#ifdef PANIC
        /* Shutdown after a servo has panicked, while a thread recovers its finger. */
        callers = 2;
        run Recoverer(0); run Closer();
        panics[0] = true
#endif
#ifdef CALIBRATION
        /* A finger is calibrated, faults and recovers. */
        callers = 3;
        run Calibrator(0); run Recoverer(0); run Stopper()
#endif
#ifdef AGAIN
        /* A finger is calibrated while the hand is closed and opened again. */
        callers = 3;
        run Calibrator(0); run Closer(); run Opener();
        broken[0] = true
#endif
#ifdef CALLS
        /* Shutdown during calls that hold several locks. */
        callers = 4;
        run Commander(0); run Commander(0); run Grouper(0); run Closer()
#endif
#ifdef MUTANT_GROUPS_IN_ANY_ORDER
        callers++;
        run Grouper(1);
#endif
#ifdef EXIT
        /* The process exits while calls are in progress. */
        callers = 2;
        run Exiter(); run Closer();
        broken[0] = true
#endif
    };
    callers == 0;
    close_hand();
    assert(over || (!collector_runs && !ports_run && !servo_runs[0] && !servo_runs[PORTS - 1] && writers == 0))
}
