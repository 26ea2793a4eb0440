"""Events as a queue, as an iterator and in asyncio."""

import asyncio
import select
import threading

import pytest

import sun2xp
from sun2xp import _sun2xp

AWAY = [0.2, 0.6, 0.9]


def test_the_kinds_are_those_of_the_library():
    assert [(kind.value, kind.name) for kind in sun2xp.EventKind] == _sun2xp.event_kinds()


def test_a_queue_has_the_arrival(hand):
    events = hand.events()
    assert events.take() is None and events.wait(0) is None
    hand.send_position(1, AWAY)
    for event in events:
        if event.kind == sun2xp.EventKind.ARRIVED:
            break
    assert event.finger == 1 and event.part == "finger" and event.text == "arrived" and event.cycle > 0
    assert abs(hand.position(1) - event.values).max() < 0.05
    assert events.lost == 0


def test_the_descriptor_is_readable_while_there_are_events(hand):
    events = hand.events()
    assert select.select([events], [], [], 0)[0] == []
    hand.stop(3)
    assert select.select([events], [], [], 20)[0] == [events]
    assert events.wait(5).kind == sun2xp.EventKind.FAULT
    hand.close()
    assert select.select([events], [], [], 20)[0] == [events]
    assert events.closed and events.wait() is None
    with pytest.raises(sun2xp.Closed):
        hand.events()


def test_a_queue_is_closed_as_soon_as_the_hand_is_being_closed(hand):
    events = hand.events()
    closing = threading.Thread(target=hand.close)
    closing.start()
    while not events.closed:
        pass
    assert closing.is_alive() and "being closed" in sun2xp.Events.closed.__doc__
    closing.join()


def test_asyncio_follows_events_until_the_hand_is_closed(hand):
    async def follow():
        kinds, ticks = [], 0

        async def tick():
            nonlocal ticks
            while True:
                ticks += 1
                await asyncio.sleep(0.01)

        ticking = asyncio.create_task(tick())
        # `events_async` would make its queue only at its first step. The queue of `events` exists before the command.
        events = hand.events()
        hand.send_position(1, AWAY)
        async for event in events:
            kinds.append(event.kind)
            if event.kind == sun2xp.EventKind.ARRIVED:
                await asyncio.get_running_loop().run_in_executor(None, hand.close)
        ticking.cancel()
        return kinds, ticks

    kinds, ticks = asyncio.run(asyncio.wait_for(follow(), 60))
    assert sun2xp.EventKind.ARRIVED in kinds and ticks > 5


def test_asyncio_waits_with_a_limit(hand):
    async def wait():
        events = hand.events()
        assert await events.next(timeout=0.05) is None
        hand.stop(2)
        event = await events.next(timeout=20)
        stops = hand.events_async()
        first = asyncio.ensure_future(stops.__anext__())
        await asyncio.sleep(0.05)
        hand.stop(3)
        return event, await asyncio.wait_for(first, 20)

    event, first = asyncio.run(wait())
    assert (event.kind, event.finger) == (sun2xp.EventKind.FAULT, 2) and "stop" in event.text
    assert (first.kind, first.finger) == (sun2xp.EventKind.FAULT, 3)


def test_several_tasks_wait_for_one_queue(hand):
    async def wait():
        events = hand.events()
        tasks = [asyncio.ensure_future(events.next()) for _ in range(3)]
        # A fourth wait ends without an event. The three tasks still wait.
        assert await events.next(timeout=0.05) is None
        hand.stop(1)
        done, waiting = await asyncio.wait(tasks, timeout=20, return_when=asyncio.FIRST_COMPLETED)
        assert len(done) == 1 and len(waiting) == 2
        await asyncio.get_running_loop().run_in_executor(None, hand.close)
        return await asyncio.wait_for(asyncio.gather(*tasks), 20)

    found = asyncio.run(wait())
    assert sorted(event is None for event in found) == [False, True, True]
