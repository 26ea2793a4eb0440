/* Tests several hands in one process: each moves alone, and keeps its own errors for each thread. Handles that are
   null, foreign or closed are refused. Also tests messages and versions. C89. */
#include <errno.h>
#include <pthread.h>
#include <string.h>
#include "Sun2Xp.h"
#include "sun2xp.h"
#include "check.h"

/* The scheduling of the machine does not matter here. */
#define PLAIN "[hand]\nreal_time = \"ignore\"\n[finger]\nport = \"simulated\"\n"
#define REFUSED(Call, Number, Errno, Word) \
    do { \
        errno = 0; \
        CHECK((Call) == -(Number)); \
        CHECK(errno == (Errno)); \
        CHECK(strstr(sun2xp_error_text(NULL), (Word)) != NULL); \
    } while (0)

static int messages, last_severity;
static char last_message[2048];

static void take_message(int severity, const char *text, void *user)
{
    *(int *)user += 1;
    last_severity = severity;
    strncpy(last_message, text, sizeof last_message - 1);
    /* The callback cannot replace itself, because sun2xp_set_log would wait until the callback has returned. */
    if (sun2xp_set_log(NULL, NULL) != -SUN2XP_ERROR_BUSY)
        *(int *)user += 1000;
}

static void knows_its_versions(void)
{
    CHECK(strcmp(sun2xp_version(), SUN2XP_VERSION) == 0);
    CHECK(sun2xp_version_number() == SUN2XP_VERSION_NUMBER);
    CHECK(SUN2XP_VERSION_MAJOR * 10000 + SUN2XP_VERSION_MINOR * 100 + SUN2XP_VERSION_PATCH == SUN2XP_VERSION_NUMBER);
    CHECK(sun2xp_abi_version() == SUN2XP_ABI_VERSION);
}

static void refuses_what_is_no_handle(sun2xp_hand *closed)
{
    double position[3] = {7, 8, 9};
    static double foreign[64];

    REFUSED(sun2xp_position(NULL, 1, position), SUN2XP_ERROR_NO_HAND, ENODEV, "sun2xp_open");
    REFUSED(sun2xp_position((sun2xp_hand *)(void *)foreign, 1, position), SUN2XP_ERROR_NO_HAND, ENODEV, "sun2xp_open");
    REFUSED(sun2xp_position((sun2xp_hand *)(void *)position, 1, position), SUN2XP_ERROR_NO_HAND, ENODEV, "handle");
    REFUSED(sun2xp_position(closed, 1, position), SUN2XP_ERROR_NO_HAND, ENODEV, "handle");
    REFUSED(sun2xp_send_position(closed, 1, position), SUN2XP_ERROR_NO_HAND, ENODEV, "handle");
    REFUSED(sun2xp_close(closed), SUN2XP_ERROR_NO_HAND, ENODEV, "sun2xp_close");
    REFUSED(sun2xp_close(NULL), SUN2XP_ERROR_NO_HAND, ENODEV, "sun2xp_close");
    CHECK(position[0] == 7 && position[1] == 8 && position[2] == 9);
}

static void refuses_what_cannot_be_opened(void)
{
    sun2xp_hand *hand = NULL;

    REFUSED(sun2xp_open("no/such/file.toml", &hand), SUN2XP_ERROR_CONFIGURATION, ENOENT, "no/such/file.toml");
    REFUSED(sun2xp_open(NULL, NULL), SUN2XP_ERROR_ARGUMENT, EFAULT, "hand");
    REFUSED(sun2xp_open_text(NULL, &hand), SUN2XP_ERROR_ARGUMENT, EFAULT, "configuration");
    REFUSED(sun2xp_open_text("[hand]\nrat = 1\n", &hand), SUN2XP_ERROR_CONFIGURATION, EINVAL, "configuration text:2");
    REFUSED(sun2xp_open_text("#\n# \xff\n", &hand), SUN2XP_ERROR_CONFIGURATION, EINVAL,
        "configuration text:2: the line is not UTF-8");
    REFUSED(sun2xp_open_named("golden", &hand), SUN2XP_ERROR_ARGUMENT, EINVAL, "sheathed");
    CHECK(hand == NULL);
}

/* Sends a finger of one hand somewhere, and returns where the same finger of the other hand is. */
static double moves_alone(sun2xp_hand *moving, sun2xp_hand *resting, double angle)
{
    double sent[3] = {0, 0.5, 0}, moved[3], rested[3];
    int tries = 0;

    sent[2] = angle;
    CHECK(sun2xp_send_position(moving, 1, sent) == 0);
    do {
        CHECK(++tries < 1000);
        PAUSE_MS(10);
        CHECK(sun2xp_position(moving, 1, moved) == 0);
    } while (APART(moved[2], angle) > 0.02);
    CHECK(sun2xp_position(resting, 1, rested) == 0);
    return rested[2];
}

static void *refused_elsewhere(void *hand)
{
    struct sun2xp_error error;
    double position[3];

    error.size = sizeof error;
    CHECK(sun2xp_error((sun2xp_hand *)hand, &error) == 0 && error.number == 0 && error.text[0] == '\0');
    CHECK(sun2xp_position((sun2xp_hand *)hand, 77, position) == -SUN2XP_ERROR_ARGUMENT);
    CHECK(strstr(sun2xp_error_text((sun2xp_hand *)hand), "77") != NULL);
    return NULL;
}

static void keeps_errors_apart(sun2xp_hand *a, sun2xp_hand *b)
{
    double far[3] = {9, 0.5, 0.9}, position[3];
    struct { struct sun2xp_error known; double later; } newer;
    struct sun2xp_error error;
    pthread_t other;

    CHECK(sun2xp_send_position(a, 1, far) == -SUN2XP_ERROR_LIMIT && errno == ERANGE);
    CHECK(sun2xp_position(b, 44, position) == -SUN2XP_ERROR_ARGUMENT && errno == EINVAL);
    CHECK(pthread_create(&other, NULL, refused_elsewhere, a) == 0 && pthread_join(other, NULL) == 0);
    error.size = sizeof error;
    CHECK(sun2xp_error(a, &error) == 0 && error.number == SUN2XP_ERROR_LIMIT && error.system_errno == ERANGE);
    CHECK(strcmp(error.call, "sun2xp_send_position") == 0 && strstr(error.text, "joint 0") != NULL);
    CHECK(error.remedy[0] == '\0' && error.size == sizeof error);
    CHECK(sun2xp_error(b, &error) == 0 && error.number == SUN2XP_ERROR_ARGUMENT);
    CHECK(strcmp(error.call, "sun2xp_position") == 0 && strstr(error.text, "44") != NULL);
    CHECK(sun2xp_error(NULL, &error) == 0 && strstr(error.text, "44") != NULL);
    CHECK(strcmp(HandError(), sun2xp_error_text(NULL)) == 0);
    CHECK(GetPos(1, position) == -1 && strstr(HandError(), "OpenHand") != NULL);
    CHECK(strstr(sun2xp_error_text(b), "44") != NULL);

    errno = 0;
    error.size = sizeof error - 1;
    CHECK(sun2xp_error(a, &error) == -SUN2XP_ERROR_ARGUMENT && errno == 0);
    CHECK(sun2xp_error(a, NULL) == -SUN2XP_ERROR_ARGUMENT && errno == 0);
    newer.known.size = sizeof newer;
    newer.later = 5;
    CHECK(sun2xp_error(a, &newer.known) == 0 && newer.later == 0 && newer.known.number == SUN2XP_ERROR_LIMIT);
}

static void *opens_and_closes(void *Unused)
{
    int round;

    (void)Unused;
    for (round = 0; round < 3; round++) {
        sun2xp_hand *hand;
        double position[3];

        CHECK(sun2xp_open_text(PLAIN, &hand) == 0);
        CHECK(sun2xp_position(hand, 3, position) == 0);
        CHECK(sun2xp_close(hand) == 0);
        CHECK(sun2xp_position(hand, 3, position) == -SUN2XP_ERROR_NO_HAND);
    }
    return NULL;
}

static void shares_the_table_with_the_calls_of_1990(void)
{
    double position[3], at[3];
    sun2xp_hand *hand;

    CHECK(sun2xp_default_hand() == NULL);
    CHECK(OpenHand() == 0);
    hand = sun2xp_default_hand();
    CHECK(hand != NULL && sun2xp_position(hand, 2, position) == 0 && GetPos(2, at) == 0);
    CHECK(GetPos(9, at) == -1 && strncmp(sun2xp_error_text(hand), "GetPos: ", 8) == 0);
    CHECK(sun2xp_close(hand) == 0 && sun2xp_default_hand() == NULL);
    CHECK(GetPos(2, at) == -1 && errno == ENODEV);
    CHECK(CloseHand() == 0);
    CHECK(OpenHand() == 0 && sun2xp_default_hand() != hand);
    CHECK(sun2xp_position(hand, 2, position) == -SUN2XP_ERROR_NO_HAND && GetPos(2, at) == 0);
    CHECK(CloseHand() == 0);
}

int main(void)
{
    sun2xp_hand *a, *b, *named;
    pthread_t threads[2];
    double before;

    CHECK(sun2xp_set_log(take_message, &messages) == 0);
    knows_its_versions();
    refuses_what_cannot_be_opened();
    CHECK(messages > 0 && messages < 1000 && last_severity == SUN2XP_LOG_REFUSAL);
    CHECK(strncmp(last_message, "sun2xp_open", 11) == 0);
    CHECK(sun2xp_open_text(PLAIN, &a) == 0 && sun2xp_open_text(PLAIN, &b) == 0);
    CHECK(a != b && a != NULL && b != NULL && sun2xp_default_hand() == NULL);
    before = moves_alone(a, b, 1.2);
    CHECK(APART(moves_alone(a, b, 0.6), before) < 0.02);
    moves_alone(b, a, 1.0);
    keeps_errors_apart(a, b);
    CHECK(sun2xp_close(a) == 0);
    refuses_what_is_no_handle(a);
    before = moves_alone(b, b, 0.8);

    CHECK(pthread_create(&threads[0], NULL, opens_and_closes, NULL) == 0);
    CHECK(pthread_create(&threads[1], NULL, opens_and_closes, NULL) == 0);
    CHECK(pthread_join(threads[0], NULL) == 0 && pthread_join(threads[1], NULL) == 0);
    CHECK(sun2xp_open_named("worn", &named) == 0 && sun2xp_close(named) == 0);
    messages = 0;
    shares_the_table_with_the_calls_of_1990();
    /* OpenHand has announced that the hand is simulated. */
    CHECK(messages > 0 && messages < 1000);
    CHECK(sun2xp_set_log(NULL, NULL) == 0);
    return sun2xp_close(b);
}
