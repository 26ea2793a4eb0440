// Spring.cpp - two hands in one program: one finger of each hand moves and comes to rest. Then the program catches the
// exception of a refused call. C++17.

#include <chrono>
#include <cstdio>
#include <stdexcept>
#include "sun2xp.hpp"

using namespace std::chrono_literals;

int main()
{
    try {
        const sun2xp::matrix3 stiffness = {{{3, 0, 0}, {0, 3, 0}, {0, 0, 3}}};
        sun2xp::hand left = sun2xp::hand::named("nominal"), right = sun2xp::hand::named("worn");

        for (const sun2xp::hand *hand : {&left, &right}) {
            sun2xp::finger finger = hand->finger(1);
            finger.send_stiffness(stiffness);
            finger.send_position({0.1, 0.6, finger.limits().joint_maximum[2] / 2});
            if (!finger.wait(sun2xp::until::settled, 10s))
                throw std::runtime_error("finger 1 has not come to rest within 10 s: run this on a less busy machine");
            const auto [j0, j1, j2] = finger.position();
            std::printf("finger 1 rests at %.3f %.3f %.3f rad\n", j0, j1, j2);
        }
        try {
            left.finger(1).send_position({0.0, 9.0, 0.8});
            throw std::runtime_error("a pose beyond the joint limits was accepted: set hand.out_of_range = \"refuse\"");
        } catch (const sun2xp::error &refused) {
            if (refused.number() != SUN2XP_ERROR_LIMIT)
                throw;
            std::printf("as expected: error %d of %s\n", refused.number(), refused.call().c_str());
            right.close();
            return 0;
        }
    } catch (const std::exception &failure) {
        std::fprintf(stderr, "%s\n", failure.what());
    }
    return 1;
}
