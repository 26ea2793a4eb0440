/* A planner that takes the addresses of the calls, and declares the calls itself (except with NO_DECLARATIONS). The
   compiler options define REAL, the type of its arrays. They also define either SUN2XP_REAL as the same type, or the
   header's include guard SUN2XP_H, which leaves the header out. */
#include "Sun2Xp.h"
#include "check.h"

#ifdef ANSI_DECLARATIONS
extern int SendPos(int, REAL *);
extern int GetPos(int, REAL *);
extern int OpenHand(void);
extern int CloseHand(void);
extern char *HandError(void);
#elif !defined(NO_DECLARATIONS)
int OpenHand();
int SendPos();
int SendKx();
int GetPos();
int CloseHand();
#endif

#ifdef ANSI_DECLARATIONS
static int (*move)(int, REAL *) = SendPos;
#else
static int (*move)(int, const REAL *) = SendPos;
#endif
static int (*look)(int, REAL *) = GetPos;

int main(void)
{
    REAL Sent[3] = {0.0, 0.5, 1.1}, Pos[3];
    int joint;

    CHECK(OpenHand() == 0);
    CHECK(move(2, Sent) == 0);
    PAUSE_MS(3000);
    CHECK(look(2, Pos) == 0);
    for (joint = 0; joint < 3; joint++)
        CHECK(APART(Pos[joint], Sent[joint]) < 0.02);
    CHECK((*move)(4, Sent) == -1);
    CHECK(CloseHand() == 0);
    return 0;
}
