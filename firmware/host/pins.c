/* Prints the pins of the STM32F405 as the Markdown table of stm32f405/README.md. */

#include "../stm32f405/pins.h"
#include <stdio.h>

#define ROW(port, number, mode, alternate, pull, name, signal, connection)                                             \
    print_row(#port, number, alternate, pull, signal, connection);

static void print_row(const char *port, int number, int alternate, enum pin_pull pull, const char *signal,
                      const char *connection)
{
    static const char *const pulls[] = {[NO_PULL] = "", [PULL_UP] = "up", [PULL_DOWN] = "down"};
    printf("| P%s%d | %s |", port, number, signal);
    if (alternate > 0)
        printf(" %d |", alternate);
    else
        printf(" |");
    printf(" %s%s| %s |\n", pulls[pull], pull == NO_PULL ? "" : " ", connection);
}

int main(void)
{
    puts("| pin | signal | alternate function | pull | connection |");
    puts("|---|---|---|---|---|");
    PINS(ROW)
    return 0;
}
