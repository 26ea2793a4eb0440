/* The registers of the STM32F405 that this port uses. Registers and bits have the names of the chip's reference manual,
   RM0090. The registers of each struct are in the order of that manual. Numbers in comments are its sections, unless
   another manual is named.

   These few definitions replace the vendor's header, which has more than 10 000 lines. A reader can compare each one
   with the manual. */

#ifndef FIRMWARE_REGISTERS_H
#define FIRMWARE_REGISTERS_H

#include <stdint.h>

/* 7.3 Reset and clock control. */
struct rcc {
    volatile uint32_t CR, PLLCFGR, CFGR, CIR, AHB1RSTR, AHB2RSTR, AHB3RSTR, reserved_1c, APB1RSTR, APB2RSTR,
        reserved_28[2], AHB1ENR, AHB2ENR, AHB3ENR, reserved_3c, APB1ENR, APB2ENR;
};
#define RCC ((struct rcc *)0x40023800u)
enum { RCC_CR_HSEON = 1 << 16, RCC_CR_HSERDY = 1 << 17, RCC_CR_CSSON = 1 << 19 };      /* 7.3.1 */
enum { RCC_CR_PLLON = 1 << 24, RCC_CR_PLLRDY = 1 << 25 };                              /* 7.3.1 */
enum { RCC_PLLCFGR_PLLN_SHIFT = 6, RCC_PLLCFGR_PLLSRC_HSE = 1 << 22, RCC_PLLCFGR_PLLQ_SHIFT = 24 }; /* 7.3.2 */
enum { RCC_CFGR_SW_PLL = 2, RCC_CFGR_SWS_MASK = 3 << 2, RCC_CFGR_SWS_PLL = 2 << 2 };   /* 7.3.3 */
enum { RCC_CFGR_PPRE1_DIV4 = 5 << 10, RCC_CFGR_PPRE2_DIV2 = 4 << 13 };                 /* 7.3.3 */
enum { RCC_AHB1ENR_GPIOA = 1 << 0, RCC_AHB1ENR_GPIOB = 1 << 1, RCC_AHB1ENR_GPIOC = 1 << 2 }; /* 7.3.10 */
enum { RCC_APB1ENR_TIM2 = 1 << 0, RCC_APB1ENR_TIM3 = 1 << 1, RCC_APB1ENR_TIM4 = 1 << 2 };    /* 7.3.13 */
enum { RCC_APB1ENR_TIM5 = 1 << 3, RCC_APB1ENR_SPI2 = 1 << 14, RCC_APB1ENR_PWR = 1 << 28 };   /* 7.3.13 */
enum { RCC_APB2ENR_TIM8 = 1 << 1, RCC_APB2ENR_USART1 = 1 << 4 };                       /* 7.3.14 */

/* 3.9.1 Flash access control. */
#define FLASH_ACR (*(volatile uint32_t *)0x40023C00u)
enum { FLASH_ACR_LATENCY_5 = 5, FLASH_ACR_ICEN = 1 << 9, FLASH_ACR_DCEN = 1 << 10 };

/* 5.4.1 Power control. */
#define PWR_CR (*(volatile uint32_t *)0x40007000u)
enum { PWR_CR_VOS = 1 << 14 };

/* 8.4 General-purpose I/O. */
struct gpio {
    volatile uint32_t MODER, OTYPER, OSPEEDR, PUPDR, IDR, ODR, BSRR, LCKR, AFR[2];
};
enum { GPIO_OSPEEDR_MEDIUM = 1 };                                                  /* 8.4.3 */
#define GPIOA ((struct gpio *)0x40020000u)
#define GPIOB ((struct gpio *)0x40020400u)
#define GPIOC ((struct gpio *)0x40020800u)

/* 17.4 TIM8 (advanced control), 18.4 TIM2 to TIM5 (general purpose). CNT and ARR have 32 bits in TIM2 and TIM5 only. */
struct timer {
    volatile uint32_t CR1, CR2, SMCR, DIER, SR, EGR, CCMR1, CCMR2, CCER, CNT, PSC, ARR, RCR, CCR[4], BDTR;
};
#define TIM2 ((struct timer *)0x40000000u)
#define TIM3 ((struct timer *)0x40000400u)
#define TIM4 ((struct timer *)0x40000800u)
#define TIM5 ((struct timer *)0x40000C00u)
#define TIM8 ((struct timer *)0x40010400u)
enum { TIM_CR1_CEN = 1 << 0 };                                                     /* 18.4.1 */
enum { TIM_SMCR_SMS_ENCODER_BOTH = 3 };                                            /* 18.4.3 */
enum { TIM_SR_UIF = 1 << 0, TIM_SR_BIF = 1 << 7 };                                 /* 17.4.5 */
enum { TIM_EGR_UG = 1 << 0 };                                                      /* 17.4.6 */
enum { TIM_CCMR_CC1S_TI1 = 1 << 0, TIM_CCMR_CC2S_TI2 = 1 << 8 };                   /* 18.4.7 */
enum { TIM_CCMR_IC1F_SHIFT = 4, TIM_CCMR_IC2F_SHIFT = 12 };                        /* 18.4.7 */
enum { TIM_CCMR_OC1M_PWM1 = 6 << 4, TIM_CCMR_OC2M_PWM1 = 6 << 12 };                /* 17.4.7 */
enum { TIM_CCER_CC1E = 1 << 0, TIM_CCER_CC2E = 1 << 4, TIM_CCER_CC3E = 1 << 8, TIM_CCER_CC4E = 1 << 12 }; /* 17.4.9 */
enum { TIM_BDTR_OSSI = 1 << 10, TIM_BDTR_BKE = 1 << 12, TIM_BDTR_BKP = 1 << 13, TIM_BDTR_MOE = 1 << 15 }; /* 17.4.18 */

/* 21.4 Independent watchdog. */
struct watchdog {
    volatile uint32_t KR, PR, RLR, SR;
};
#define IWDG ((struct watchdog *)0x40003000u)
enum { IWDG_KR_UNLOCK = 0x5555, IWDG_KR_FEED = 0xAAAA, IWDG_KR_START = 0xCCCC };   /* 21.4.1 */

/* 28.5 SPI. */
struct spi {
    volatile uint32_t CR1, CR2, SR, DR;
};
#define SPI2 ((struct spi *)0x40003800u)
enum { SPI_CR1_CPOL = 1 << 1, SPI_CR1_MSTR = 1 << 2, SPI_CR1_BR_DIV4 = 1 << 3, SPI_CR1_SPE = 1 << 6 };  /* 28.5.1 */
enum { SPI_CR1_SSI = 1 << 8, SPI_CR1_SSM = 1 << 9, SPI_CR1_DFF_16 = 1 << 11 };     /* 28.5.1 */
enum { SPI_SR_RXNE = 1 << 0, SPI_SR_TXE = 1 << 1 };                                /* 28.5.3 */

/* 30.6 USART. */
struct usart {
    volatile uint32_t SR, DR, BRR, CR1, CR2, CR3, GTPR;
};
#define USART1 ((struct usart *)0x40011000u)
enum { USART_SR_ORE = 1 << 3, USART_SR_RXNE = 1 << 5, USART_SR_TXE = 1 << 7 };     /* 30.6.1 */
enum { USART_CR1_RE = 1 << 2, USART_CR1_TE = 1 << 3, USART_CR1_RXNEIE = 1 << 5 };  /* 30.6.4 */
enum { USART_CR1_TXEIE = 1 << 7, USART_CR1_UE = 1 << 13 };                         /* 30.6.4 */

/* The interrupt controller (ARMv7-M Architecture Reference Manual, B3.4), and the number of the interrupt of USART1
   (12.2, table 61). */
#define NVIC_ISER ((volatile uint32_t *)0xE000E100u)
#define NVIC_IPR ((volatile uint8_t *)0xE000E400u)
enum { INTERRUPT_USART1 = 37 };

#endif
