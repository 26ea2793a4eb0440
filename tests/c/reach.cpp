// A planner in the common subset of C++98 to C++17, with float and double side by side.
#include <cerrno>
#include <cstddef>
#include "Sun2Xp.h"
#include "Sun2Xp.h"
#include "check.h"

#define REFUSED(Call) CHECK((errno = 0, (Call)) == -1 && errno == EFAULT)

template <class Real> void reach(int finger)
{
    const Real target[3] = {Real(0.1), Real(0.5), Real(0.9)};
    Real changeable[3] = {target[0], target[1], target[2]};
    const Real kx[3][3] = {{3, 0, 0}, {0, 3, 0}, {0, 0, 3}};
    Real rows[3][3] = {{3, 0, 0}, {0, 3, 0}, {0, 0, 3}};
    Real flat[9] = {3, 0, 0, 0, 3, 0, 0, 0, 3};

    CHECK(SendKx(finger, kx) == 0);
    CHECK(SendKx(finger, rows) == 0);
    CHECK(SendKx(finger, flat) == 0);
    CHECK(SendPos(finger, target) == 0);
    CHECK(SendPos(finger, changeable) == 0);
    PAUSE_MS(3000);
    Real now[3];
    CHECK(GetPos(finger, now) == 0);
    for (int joint = 0; joint < 3; joint++)
        CHECK(APART(now[joint], target[joint]) < 0.02);
}

int main()
{
    CHECK(OpenHand() == 0);
    reach<float>(1);
    reach<double>(2);
    REFUSED(SendPos(1, NULL));
    REFUSED(SendPos(1, 0));
    REFUSED(SendPos(1, static_cast<double *>(NULL)));
    REFUSED(SendKx(1, NULL));
    REFUSED(GetPos(1, NULL));
#if __cplusplus >= 201103L
    REFUSED(SendPos(1, nullptr));
    REFUSED(GetPos(1, nullptr));
#endif
    int (*send_float)(int, const float *) = SendPos;
    int (*send_double)(int, const double *) = SendPos;
    CHECK(send_float(4, NULL) == -1 && send_double(4, NULL) == -1);
    CHECK(CloseHand() == 0);
    return 0;
}
