#include "startup.h"
#include <stdint.h>

/* Symbols of the linker script. */
extern uint32_t data_begin, data_end, bss_begin, bss_end;
extern const uint32_t data_image;

int main(void);

void reset(void)
{
    const uint32_t *from = &data_image;
    for (uint32_t *to = &data_begin; to < &data_end; to++)
        *to = *from++;
    for (uint32_t *to = &bss_begin; to < &bss_end; to++)
        *to = 0;
    main();
    /* main does not return. */
    processor_fault();
}
