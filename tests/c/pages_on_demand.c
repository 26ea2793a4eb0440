/* A planner whose SIGSEGV handler makes a page accessible when it is first touched, as garbage collectors do. Every
   call that reads or writes the planner's memory finds such a page. */
#define _GNU_SOURCE
#include <signal.h>
#include <string.h>
#include <sys/mman.h>
#include "Sun2Xp.h"
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
        ((struct Type *)page)->Size = sizeof(struct Type); \
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
    ON_DEMAND(SendContact(1, 3, numbers, NULL));
    ON_DEMAND_STRUCT(FingerStatus, GetStatus(1, (struct FingerStatus *)page));
    ON_DEMAND_STRUCT(FingerTip, GetTip(1, (struct FingerTip *)page));
    ON_DEMAND_STRUCT(FingerTiming, GetTiming(1, TIMING_CYCLE, (struct FingerTiming *)page));
    ON_DEMAND_STRUCT(FingerRecord, GetRecord(1, 0, (struct FingerRecord *)page));
    ON_DEMAND_STRUCT(Fault, GetFault(1, (struct Fault *)page));
    strcpy(page, "tendon.minimum = 6");
    ON_DEMAND(AdjustFinger(1, page));
    strcpy(page, "on_demand.jsonl");
    ON_DEMAND(WriteBlackBox(1, page));
    CHECK(CloseHand() == 0);
    return 0;
}
