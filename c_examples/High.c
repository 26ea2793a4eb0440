/* High.c - the planner of Figure 6 of COINS Technical Report 90-48, completed.

   make run        (in this folder) compiles it and runs it on the simulated hand

   Each finger becomes a spring of 3 N/cm and is sent to a pose. The exit status is 0 if every finger arrives. */

#include <stdio.h>
#include <unistd.h>
#include "Sun2Xp.c"
#include "sun2xp.h"

float Pos[3][3] = {{0.10, 0.50, 0.90}, {-0.10, 0.50, 0.90}, {0.00, 0.60, 1.10}};        /* rad */
float Kx[3][3] = {{3.0, 0.0, 0.0}, {0.0, 3.0, 0.0}, {0.0, 0.0, 3.0}};                   /* N/cm */

int main( )
{
  float Now[3], off;
  struct sun2xp_status Status;
  int i, joint, arrived, tries;

  if (OpenHand( ) != 0) {
    fprintf(stderr, "%s\n", HandError( ));
    return 1;
  }
  for (i = 1; i <= 3; i++) {
    if (SendKx(i, Kx) != 0 || SendPos(i, Pos[i - 1]) != 0)
      fprintf(stderr, "%s\n", HandError( ));
  }

  arrived = 0;
  for (tries = 0; arrived < 3 && tries < 8; tries++) {
    sleep(1);
    arrived = 0;
    for (i = 1; i <= 3; i++) {
      int near = GetPos(i, Now) == 0;
      for (joint = 0; near && joint < 3; joint++) {
        off = Now[joint] - Pos[i - 1][joint];
        near = off <= 0.02 && off >= -0.02;
      }
      arrived += near;
    }
  }

  printf("finger   joint angles, rad                servo rate   jitter: median, 99 %%, worst\n");
  for (i = 1; i <= 3; i++) {
    Status.size = sizeof Status;
    if (GetPos(i, Now) != 0 || sun2xp_status(sun2xp_default_hand(), i, &Status) != 0) {
      fprintf(stderr, "%s\n", HandError( ));
      continue;
    }
    printf("%d        sent to %6.3f %6.3f %6.3f\n", i, Pos[i - 1][0], Pos[i - 1][1], Pos[i - 1][2]);
    printf("         is at   %6.3f %6.3f %6.3f      %7.1f Hz   %.0f, %.0f, %.0f us%s\n", Now[0], Now[1], Now[2],
      Status.measured_rate, Status.wake_up_median, Status.wake_up_p99, Status.wake_up_maximum,
      Status.realtime ? "" : " (not real-time)");
  }
  printf("%d of 3 fingers arrived\n", arrived);
  CloseHand( );
  return arrived == 3 ? 0 : 1;
}
