/* A planner whose SIGSEGV handler makes a page accessible when it is first touched, as garbage collectors do. Each
   ON_DEMAND call reads or writes such a page. */
#define _GNU_SOURCE
#include <signal.h>
#include <string.h>
#include <sys/mman.h>
#include "Sun2Xp.h"
#include "sun2xp.h"
#include "check.h"

#define PAGE 4096

static char *page;
static volatile sig_atomic_t faults;

static void on_fault(int signal_number, siginfo_t *fault, void *context)
{
    (void)signal_number;
    (void)context;
    if ((char *)fault->si_addr < page || (char *)fault->si_addr >= page + PAGE)
        abort();
    faults++;
    mprotect(page, PAGE, PROT_READ | PROT_WRITE);
}

/* Makes the call while the page is not accessible. */
#define ON_DEMAND(Call) \
    do { \
        faults = 0; \
        CHECK(mprotect(page, PAGE, PROT_NONE) == 0); \
        CHECK((Call) == 0); \
        CHECK(faults == 1); \
    } while (0)

#define ON_DEMAND_STRUCT(Type, Call) \
    do { \
        ((struct Type *)page)->size = sizeof(struct Type); \
        ON_DEMAND(Call); \
    } while (0)

int main(void)
{
    struct sigaction action;
    double *numbers, Stiffness[9] = {3, 0, 0, 0, 3, 0, 0, 0, 3};

    page = mmap(NULL, PAGE, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    CHECK(page != MAP_FAILED);
    numbers = (double *)page;
    memset(&action, 0, sizeof action);
    action.sa_sigaction = on_fault;
    action.sa_flags = SA_SIGINFO;
    CHECK(sigaction(SIGSEGV, &action, NULL) == 0);
    CHECK(OpenHand() == 0);

    ON_DEMAND(GetPos(1, numbers));
    ON_DEMAND(SendPos(1, numbers));
    memcpy(numbers, Stiffness, sizeof Stiffness);
    ON_DEMAND(SendKx(1, numbers));
    ON_DEMAND(sun2xp_send_contact(HAND, 1, 3, numbers, NULL));
    ON_DEMAND_STRUCT(sun2xp_status, sun2xp_status(HAND, 1, (struct sun2xp_status *)page));
    ON_DEMAND_STRUCT(sun2xp_tip, sun2xp_tip(HAND, 1, (struct sun2xp_tip *)page));
    ON_DEMAND_STRUCT(sun2xp_timing, sun2xp_timing(HAND, 1, SUN2XP_STAGE_CYCLE, (struct sun2xp_timing *)page));
    ON_DEMAND_STRUCT(sun2xp_record, sun2xp_record(HAND, 1, 0, (struct sun2xp_record *)page));
    ON_DEMAND_STRUCT(sun2xp_fault, sun2xp_fault(HAND, 1, (struct sun2xp_fault *)page));
    strcpy(page, "tendon.minimum = 6");
    ON_DEMAND(sun2xp_adjust(HAND, 1, page));
    strcpy(page, "on_demand.jsonl");
    ON_DEMAND(sun2xp_write_black_box(HAND, 1, page));
    CHECK(CloseHand() == 0);
    return 0;
}
