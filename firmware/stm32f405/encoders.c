/* Four timers count the edges of the encoders. TIM2 and TIM5 have 32 bits. TIM3 and TIM4 have 16 bits and are extended
   here. encoders_latch reads all four within 0.5 us. */

#include "parts.h"
#include "registers.h"

static struct timer *const timers[MOTORS] = {TIM2, TIM5, TIM3, TIM4};

/* An edge counts after the new level has lasted for 6 samples, 0.14 us. The timer samples at 42 MHz, half of its clock
   of 84 MHz (RM0090, 18.4.7, ICxF = 4). So an encoder may deliver 3 million edges per second (one in 0.33 us). */
enum { FILTER = 4 };

static uint32_t raw[MOTORS];
static uint16_t latest[MOTORS];
static int32_t extended[MOTORS];

void encoders_start(void)
{
    RCC->APB1ENR |= RCC_APB1ENR_TIM2 | RCC_APB1ENR_TIM3 | RCC_APB1ENR_TIM4 | RCC_APB1ENR_TIM5;
    (void)RCC->APB1ENR;
    for (unsigned motor = 0; motor < MOTORS; motor++) {
        struct timer *timer = timers[motor];
        timer->ARR = 0xFFFFFFFFu;
        timer->CCMR1 = TIM_CCMR_CC1S_TI1 | TIM_CCMR_CC2S_TI2 | (uint32_t)FILTER << TIM_CCMR_IC1F_SHIFT |
                       (uint32_t)FILTER << TIM_CCMR_IC2F_SHIFT;
        timer->SMCR = TIM_SMCR_SMS_ENCODER_BOTH;
        timer->CR1 = TIM_CR1_CEN;
    }
}

void encoders_latch(void)
{
    for (unsigned motor = 0; motor < MOTORS; motor++)
        raw[motor] = timers[motor]->CNT;
}

void encoders_read(int32_t counts[MOTORS])
{
    for (unsigned motor = 0; motor < 2; motor++)
        counts[motor] = (int32_t)raw[motor];
    for (unsigned motor = 2; motor < MOTORS; motor++) {
        /* `moved` is correct if the motor moves by less than 32 768 counts between two calls. The sum is unsigned, so
           it may wrap. */
        int16_t moved = (int16_t)(uint16_t)((raw[motor] & 0xFFFFu) - latest[motor]);
        latest[motor] = (uint16_t)(raw[motor] & 0xFFFFu);
        extended[motor] = (int32_t)((uint32_t)extended[motor] + (uint32_t)moved);
        counts[motor] = extended[motor];
    }
}
