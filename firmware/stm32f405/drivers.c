/* Four PWM outputs of TIM8 are the references of the drivers' current loops. A pin for each driver gives the sign of
   its current. One pin enables all drivers. The emergency stop turns the PWM off through the break input of TIM8,
   without software. */

#include "parts.h"
#include "pins.h"
#include "registers.h"

/* 168 MHz / 4200 is 40 kHz. A step is 500 uA, so the full duty stands for 2.1 A. If your drivers have another scale,
   change MICROAMPERES_PER_STEP. */
enum { STEPS = 4200, MICROAMPERES_PER_STEP = 500 };

enum { ALL_OUTPUTS = TIM_CCER_CC1E | TIM_CCER_CC2E | TIM_CCER_CC3E | TIM_CCER_CC4E };

/* Outputs are low while MOE is clear (OSSI; the idle levels in CR2 are 0). The break input is active high. MOE does not
   return by itself after a break. */
enum { BREAK = TIM_BDTR_OSSI | TIM_BDTR_BKE | TIM_BDTR_BKP };

void drivers_start(void)
{
    RCC->APB2ENR |= RCC_APB2ENR_TIM8;
    (void)RCC->APB2ENR;
    TIM8->ARR = STEPS - 1;
    TIM8->CCMR1 = TIM_CCMR_OC1M_PWM1 | TIM_CCMR_OC2M_PWM1;
    TIM8->CCMR2 = TIM_CCMR_OC1M_PWM1 | TIM_CCMR_OC2M_PWM1;
    TIM8->CCER = ALL_OUTPUTS;
    TIM8->BDTR = BREAK;
    TIM8->EGR = TIM_EGR_UG;
    TIM8->SR = 0;
    TIM8->CR1 = TIM_CR1_CEN;
}

void drivers_off(void)
{
    GPIOC->BSRR = 1u << (PIN_ENABLE + 16);
    TIM8->BDTR = BREAK;
}

void drivers_set(const int32_t microamperes[MOTORS])
{
    uint32_t pins = 0, any = 0;
    for (unsigned motor = 0; motor < MOTORS; motor++) {
        int32_t current = microamperes[motor];
        uint32_t steps = (uint32_t)(current < 0 ? -current : current) / MICROAMPERES_PER_STEP;
        TIM8->CCR[motor] = steps < STEPS ? steps : STEPS;
        any |= steps;
        /* The upper half of BSRR resets pins. */
        pins |= 1u << (PIN_DIRECTION_1 + motor + (current < 0 ? 16u : 0u));
    }
    if (any == 0) {
        drivers_off();
        return;
    }
    GPIOC->BSRR = pins;
    /* Has no effect while the emergency stop is open: hardware keeps MOE clear (RM0090, 17.4.18). */
    TIM8->BDTR = BREAK | TIM_BDTR_MOE;
    GPIOC->BSRR = 1u << PIN_ENABLE;
}

bool drivers_were_stopped(void)
{
    if (!(TIM8->SR & TIM_SR_BIF))
        return false;
    TIM8->SR = ~(uint32_t)TIM_SR_BIF;
    return true;
}
