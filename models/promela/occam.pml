/* The example of section 2.2 of the report (Figure 4): a Dispatcher and two Servers in Occam. Its channels are
 * synchronous: a sender waits until the receiver takes the message. Spin finds the deadlock that the report describes:
 * the Dispatcher waits in a PAR for Server 1 to take a command, while Server 1 waits for the Dispatcher to take a
 * result. The other branch of the PAR, which takes results, has already terminated.
 *
 * The same processes with the exchange of this library do not deadlock: -DBUFFERED replaces every channel by a buffer
 * that holds the newest message, like src/realtime/triple_buffer.rs.
 */
#define SERVERS 2

#ifdef BUFFERED
/* The newest message of a triple buffer, and whether the reader has taken it. Neither end waits. */
bool to_server[SERVERS], to_dispatcher[SERVERS];
#define SEND(channel) channel = true
#define RECEIVE(channel) atomic { channel -> channel = false }
#else
chan to_server[SERVERS] = [0] of { bit };
chan to_dispatcher[SERVERS] = [0] of { bit };
#define SEND(channel) channel ! 0
#define RECEIVE(channel) channel ? _
#endif

/* Number of branches of the PAR that have terminated. */
byte terminated;

/* A branch of the PAR: passes a command of the root transputer on to a server. */
proctype Forward()
{
    if
    :: SEND(to_server[0])
    :: SEND(to_server[1])
    fi;
    terminated++
}

/* The other branch: an ALT takes a result or finds none. The branch then computes (left out here) and exits. */
proctype Alt()
{
    if
    :: RECEIVE(to_dispatcher[0])
    :: RECEIVE(to_dispatcher[1])
    :: skip
    fi;
    terminated++
}

active proctype Dispatcher()
{
end:
    do
    :: atomic {
        terminated = 0;
        run Forward();
        run Alt()
       };
       atomic { terminated == 2 && _nr_pr == SERVERS + 1 -> skip }
    od
}

active [SERVERS] proctype Server()
{
    byte self = _pid - 1;
end:
    do
    :: RECEIVE(to_server[self]);
       SEND(to_dispatcher[self])
    od
}
