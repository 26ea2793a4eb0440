// parts.cpp - tests sun2xp.hpp: events, groups, paths, reflexes, kinematics, and which variable owns a hand.
#include <atomic>
#include <cmath>
#include <future>
#include <memory>
#include "sun2xp.hpp"
#include "check.hpp"

using namespace std::chrono_literals;

static int number_of(void (*call)(sun2xp::hand &), sun2xp::hand &hand)
{
    try {
        call(hand);
    } catch (const sun2xp::error &refused) {
        CHECK(refused.system_errno() != 0 && refused.call().rfind("sun2xp_", 0) == 0);
        return refused.number();
    }
    return 0;
}

static void is_refused(sun2xp::hand &hand)
{
    CHECK(number_of([](sun2xp::hand &hand) { hand.finger(4).position(); }, hand) == SUN2XP_ERROR_ARGUMENT);
    CHECK(number_of([](sun2xp::hand &hand) { hand.object(); }, hand) == SUN2XP_ERROR_NOT_SUPPORTED);
    CHECK(number_of([](sun2xp::hand &hand) { hand.finger(1).adjust("rat = 1"); }, hand)
          == SUN2XP_ERROR_CONFIGURATION);
    CHECK(number_of([](sun2xp::hand &) { sun2xp::hand("no/such/file.toml"); }, hand) == SUN2XP_ERROR_CONFIGURATION);
}

static void moves(sun2xp::hand &hand)
{
    const sun2xp::vector3 there = {0.1, 0.6, 1.0};
    std::atomic<int> events = 0;
    sun2xp_set_point both[2] = {};

    hand.on_event([&events](const sun2xp_event &) { events++; });
    for (int index = 0; index < 2; index++) {
        both[index].finger = index + 1;
        both[index].position = there.data();
    }
    hand.send_group({});
    hand.send_group({both[0], both[1]});
    CHECK(hand.finger(1).wait(sun2xp::until::settled, 20s) && hand.finger(2).wait(sun2xp::until::settled, 20s));
    const sun2xp::vector3 at = hand.finger(2).position();
    CHECK(std::fabs(at[1] - there[1]) < 0.05);
    CHECK(hand.wait_event(1s).has_value());
    while (hand.next_event()) {
    }
    CHECK(!hand.wait_event(0s));
    hand.on_event(nullptr);
    CHECK(events > 0 && hand.event_descriptor() >= 0);

    sun2xp_path_pose pose = {};
    pose.time = 1.0;
    pose.place[1] = 0.5;
    pose.place[2] = 0.9;
    hand.finger(1).send_path({pose});
    // The finger needs far longer for this motion than the two calls take.
    hand.finger(1).send_position({0.3, 0.9, 1.3}, 10s);
    CHECK(!hand.finger(1).wait(sun2xp::until::arrived, 0s));
}

// A callback that removes itself keeps its captured variables until it returns.
static void is_called_once(sun2xp::hand &hand)
{
    auto captured = std::make_shared<int>(0);
    const std::weak_ptr<int> witness = captured;
    std::promise<bool> found;

    hand.on_event([captured = std::move(captured), &witness, &found, &hand](const sun2xp_event &) {
        const std::weak_ptr<int> *const is_there = &witness;
        std::promise<bool> *const result = &found;
        hand.on_event(nullptr);
        result->set_value(!is_there->expired());
    });
    hand.finger(2).send_position({0.0, 0.5, 0.9});
    CHECK(found.get_future().get());
    // Waits until the callback has returned, because it uses the variables of this function.
    hand.on_event(nullptr);
}

static void knows_itself(sun2xp::hand &hand)
{
    sun2xp::finger finger = hand.finger(3);
    sun2xp_reflex rule = {};
    const sun2xp::vector3 position = {0.1, 0.5, 0.9};
    const sun2xp::vector3 back = finger.inverse_kinematics(finger.forward_kinematics(position));

    CHECK(std::fabs(back[2] - position[2]) < 1e-9);
    CHECK(finger.status().state == SUN2XP_STATE_RUNNING && finger.timing(SUN2XP_STAGE_CYCLE).count > 0);
    CHECK(finger.fault().number == 0 && finger.tip().force_directions > 0 && finger.limits().stiffness > 0);
    CHECK(finger.jacobian()[0][0] != 0 && finger.palm_pose().rotation[2][2] != 0);
    rule.condition = SUN2XP_WHEN_FORCE_ABOVE;
    rule.bound = 5;
    rule.reaction = SUN2XP_THEN_HOLD;
    finger.remove_reflex(finger.install_reflex(rule));
    finger.stop();
    while (finger.fault().number != SUN2XP_FAULT_STOP_CALL) {
    }
    CHECK(!sun2xp::fault_text(SUN2XP_FAULT_STOP_CALL).empty());
    try {
        finger.position();
        CHECK(false);
    } catch (const sun2xp::error &refused) {
        CHECK(refused.number() == SUN2XP_ERROR_FAULTED && refused.remedy().find("sun2xp_recover") == 0);
    }
    finger.recover();
    finger.position();
}

int main()
{
    sun2xp::hand first = sun2xp::hand::text("[hand]\nreal_time = \"ignore\"\n[finger]\nport = \"simulated\"\n");
    sun2xp::hand hand = std::move(first);

    CHECK(first.handle() == nullptr && hand.handle() != nullptr);
    is_refused(hand);
    moves(hand);
    is_called_once(hand);
    knows_itself(hand);
    sun2xp::hand other = sun2xp::hand::named("cheap");
    other = std::move(hand);
    other.finger(1).position();
    other.close();
    CHECK(number_of([](sun2xp::hand &hand) { hand.close(); }, other) == SUN2XP_ERROR_NO_HAND);
    return sun2xp::version() == SUN2XP_VERSION ? 0 : 1;
}
