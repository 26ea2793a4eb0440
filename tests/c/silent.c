/* hand.print_refusals belongs to one open hand: neither another hand nor a refused opening changes it. C89. */
#include "Sun2Xp.h"
#include "sun2xp.h"
#include "check.h"
#include "refusals.h"

/* The scheduling of the machine does not matter here. */
#define PLAIN "real_time = \"ignore\"\n[finger]\nport = \"simulated\"\n"
#define LOUD "[hand]\n" PLAIN
#define SILENT "[hand]\nprint_refusals = false\n" PLAIN

/* Writes the configuration file that OpenHand finds. */
static void configure(const char *text)
{
    FILE *file = fopen("sun2xp.toml", "w");

    CHECK(file != NULL && fputs(text, file) >= 0);
    CHECK(fclose(file) == 0);
}

/* Each refusal has a kind of its own, because only the first of a kind is reported. */
int main(void)
{
    static const char NoPort[] =
        "[hand]\nprint_refusals = false\nfingers = [1]\n[finger.1]\nport = \"no/such/port\"\n";
    double far[3] = {9, 0.5, 0.9}, large[3] = {1e9, 0, 0}, stiff[9] = {99, 0, 0, 0, 1, 0, 0, 0, 1}, position[3];
    sun2xp_hand *loud, *silent, *other;

    CHECK(sun2xp_set_log(count_refusal, NULL) == 0);
    CHECK(sun2xp_open_text(LOUD, &loud) == 0 && sun2xp_open_text(SILENT, &silent) == 0);
    CHECK(sun2xp_position(loud, 9, position) < 0 && refusals == 1);
    CHECK(sun2xp_send_position(silent, 1, far) < 0 && refusals == 1);
    CHECK(sun2xp_send_position(loud, 1, far) < 0 && refusals == 2);
    CHECK(sun2xp_open_text(LOUD, &other) == 0);
    CHECK(sun2xp_send_joint_torque(silent, 1, large) < 0 && refusals == 2);
    CHECK(sun2xp_close(silent) == 0 && sun2xp_close(other) == 0);
    CHECK(sun2xp_position(silent, 1, NULL) < 0 && refusals == 3);
    CHECK(sun2xp_open_text(NoPort, &other) < 0 && refusals == 4);
    CHECK(sun2xp_send_damping(loud, 1, 99) < 0 && refusals == 5);
    CHECK(sun2xp_position(NULL, 1, position) < 0 && refusals == 6);
    CHECK(sun2xp_close(loud) == 0);
    configure(SILENT);
    CHECK(OpenHand() == 0 && SendKx(1, stiff) == -1 && CloseHand() == 0 && refusals == 6);
    configure("[hand]\nrat = 1\n");
    CHECK(OpenHand() == -1 && refusals == 7);
    return 0;
}
