/* The call that recovers a finger. */

/* Recovering in src/hand/recovery.rs, and `recover` in src/capi/hand_table.rs. */
proctype Recoverer(byte f)
{
    byte p = PORT_OF(f), mine, i, before[FINGERS];
    bool waits, limited, beside_others, sent;
    mtype:stage seen[FINGERS];
    /* Recovering::begin */
    atomic {
        read_hand();
        mine = generation;
        if
        :: CLOSED_MEANWHILE || report[f].stage != FAULTED -> unread(hand); goto returned
        :: else
        fi
    };
    atomic {
        for (i : 0 .. FINGERS - 1) {
            before[i] = report[i].recoveries;
            beside_others = beside_others || (ON(p, i) && report[i].stage != FAULTED)
        };
        i = 0;
        unread(hand)
    };
    /* Recovering::reconnect, without the lock of the hand */
    do
    :: lock(repair[p]);
       atomic {
           if
           :: mine != generation || repair_gone[p] || servo_dropped[p] || over -> unlock(repair[p]); goto returned
           :: else
           fi;
           if
           :: repairs[f] != before[f] -> unlock(repair[p]); break
           :: else -> take_link(p)
           fi
       };
       if
       :: atomic { have_link[p] -> unlock(repair[p]); goto returned }       /* restore fails */
       :: atomic {
              have_link[p] ->
              assert(!repaired[p]);
              for (i : 0 .. FINGERS - 1) { if :: ON(p, i) -> repairs[i]++ :: else fi };
              i = 0;
              have_link[p] = false;
              repaired[p] = true;
              unlock(repair[p]);
              break
          }
       :: atomic { !have_link[p] && sent && !restored[f] -> repairs[f]++; unlock(repair[p]); break }
       :: atomic {
              /* If other fingers of the port still run, the handshake requires this finger to be at rest. */
              !have_link[p] && beside_others && !sent && AT_REST(f) && link_held[p] ->
              restored[f] = true;
              sent = true;
              unlock(repair[p])
          }
       :: atomic { !have_link[p] && !(sent && !restored[f]) -> unlock(repair[p]) }
       fi;
       if
       :: goto returned                                                     /* time limit */
       :: released[p] || have_link[p] || repairs[f] != before[f] || repair_gone[p] || servo_dropped[p] || over ||
          (sent && !restored[f])
       fi
    od;
    /* Recovering::poll */
    do
    :: atomic {
           read_hand();
           if
           :: CLOSED_MEANWHILE -> unread(hand); goto returned
           :: else
           fi;
           mine = generation;
           waits = false;
           limited = false;
           for (i : 0 .. FINGERS - 1) {
               seen[i] = report[i].stage;
               /* Only the fingers that were repaired count. */
               limited = limited || (ON(p, i) && seen[i] == FAULTED && repairs[i] != before[i]);
               waits = waits || (ON(p, i) && seen[i] == OPENING && repairs[i] != before[i])
           };
           i = 0;
           unread(hand)
       };
       if
       :: limited -> goto returned                              /* faulted again, or time limit */
       :: !limited && waits ->
          CLOSED_MEANWHILE || mine != generation || report[0].stage != seen[0] || report[1].stage != seen[1]
       :: !limited && !waits -> goto returned
       fi
    od;
returned:
    callers--
}
