// late.cpp - sun2xp.hpp with a library that still calls a callback after its removal, and refuses to close a hand. This
// program defines the calls of such a library itself.
#include <cmath>
#include "sun2xp.hpp"
#include "check.hpp"

static char place;
static int result_of_close, closed;
static double waited;
static void (*callback)(const struct sun2xp_event *, void *);
static void *context;

int sun2xp_open_named(const char *, sun2xp_hand **hand)
{
    *hand = reinterpret_cast<sun2xp_hand *>(&place);
    return 0;
}

int sun2xp_close(sun2xp_hand *)
{
    closed++;
    return result_of_close;
}

int sun2xp_wait_event(sun2xp_hand *, struct sun2xp_event *, double seconds)
{
    waited = seconds;
    return 0;
}

int sun2xp_wait(sun2xp_hand *, int, int, double seconds)
{
    waited = seconds;
    return -SUN2XP_ERROR_TIMED_OUT;
}

int sun2xp_on_event(sun2xp_hand *, void (*next)(const struct sun2xp_event *, void *), void *its_context)
{
    // The last function is kept, to be called later.
    if (next != nullptr) {
        callback = next;
        context = its_context;
    }
    return 0;
}

static void is_called_late()
{
    sun2xp::hand hand = sun2xp::hand::named("nominal");
    const struct sun2xp_event event = {};
    int calls = 0;

    hand.on_event([&calls](const sun2xp_event &) { calls++; });
    callback(&event, context);
    CHECK(calls == 1);
    hand.on_event(nullptr);
    callback(&event, context);
    CHECK(calls == 1);
    // The function removes itself, and must not run when the library calls the callback again.
    hand.on_event([&hand, &calls](const sun2xp_event &) {
        int *const counted = &calls;
        hand.on_event(nullptr);
        ++*counted;
    });
    callback(&event, context);
    callback(&event, context);
    CHECK(calls == 2);
}

static void is_refused()
{
    sun2xp::hand hand = sun2xp::hand::named("nominal");

    result_of_close = -SUN2XP_ERROR_BUSY;
    try {
        hand.close();
        CHECK(false);
    } catch (const sun2xp::error &refused) {
        CHECK(refused.number() == SUN2XP_ERROR_BUSY);
    }
    CHECK(hand.handle() != nullptr);
    result_of_close = 0;
    hand.close();
    CHECK(hand.handle() == nullptr);
}

// If a variable gets another hand, its previous hand is closed at once, and not only when the other variable ends.
static void is_replaced()
{
    sun2xp::hand kept = sun2xp::hand::named("nominal"), other = sun2xp::hand::named("nominal");
    sun2xp::hand &same = kept;
    const int before = closed;

    kept = std::move(other);
    CHECK(closed == before + 1);
    CHECK(kept.handle() != nullptr && other.handle() == nullptr);
    kept = std::move(same);
    CHECK(closed == before + 1 && kept.handle() != nullptr);
}

// sun2xp.hpp passes 0 instead of a negative time. With a negative time, sun2xp_wait_event would wait without a limit,
// and sun2xp_wait would refuse the call.
static void does_not_wait_after_a_deadline()
{
    sun2xp::hand hand = sun2xp::hand::named("nominal");

    for (const double past : {-1e-9, -5.0, -HUGE_VAL, std::nan("")}) {
        waited = 1;
        CHECK(!hand.wait_event(sun2xp::seconds(past)));
        CHECK(waited == 0);
        waited = 1;
        CHECK(!hand.finger(1).wait(sun2xp::until::settled, sun2xp::seconds(past)));
        CHECK(waited == 0);
    }
    hand.wait_event(std::chrono::milliseconds(20));
    CHECK(waited == 0.02);
    hand.wait_event(sun2xp::seconds(HUGE_VAL));
    CHECK(waited == HUGE_VAL);
}

int main()
{
    is_called_late();
    CHECK(closed == 1);
    is_refused();
    CHECK(closed == 3);
    is_replaced();
    CHECK(closed == 5);
    does_not_wait_after_a_deadline();
    return 0;
}
