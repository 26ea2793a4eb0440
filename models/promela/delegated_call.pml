/* A slow call from C: the planner's thread waits on a futex word for the thread that does the work
 * (src/realtime/delegated_call.rs). The model leaves out the check that the planner's thread makes every 100 ms. So the
 * planner's thread must wake up without this check. -DWAKE_FIRST is a mutant that wakes the planner before it stores
 * the result.
 */
bool done;
bool sleeping;

/* DelegatedCall::begin, and the body of its thread. */
active proctype Worker()
{
#ifdef WAKE_FIRST
    sleeping = false;
    done = true
#else
    done = true;
    sleeping = false
#endif
}

/* DelegatedCall::wait and wait_for_change. The kernel compares the word and puts the thread to sleep in one step. */
active proctype Planner()
{
    do
    :: done -> break
    :: !done ->
       atomic {
           if
           :: !done -> sleeping = true
           :: else
           fi
       };
       !sleeping
    od
}
