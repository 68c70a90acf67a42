/* Registers of the STM32F405 that this layer uses: bases, offsets, fields.
 *
 * Names are the manual's (RM0090): <PERIPHERAL>_BASE an address, <PERIPHERAL>_<REGISTER> an offset from it,
 * <PERIPHERAL>_<REGISTER>_<FIELD> the field's mask. A test holds every macro here against the chip's SVD file
 * (tests/silicon_model/test_registers.py), so nothing else may be defined here than those three kinds, the two
 * access macros, interrupt numbers (<NAME>_IRQ) and keys (..._KEY, ..._KEY1, ..._KEY2).
 */
#ifndef STM32F405_REGISTERS_H
#define STM32F405_REGISTERS_H

#include <stdint.h>

#define REGISTER(base, offset) (*(volatile uint32_t *)(uintptr_t)((base) + (offset)))
#define FIELD(mask, value) ((uint32_t)(value) * ((mask) & (0u - (mask)))) /* the value in its place */

/* Reset and clock control */
#define RCC_BASE 0x40023800u
#define RCC_CR 0x00u
#define RCC_CR_HSION (1u << 0)
#define RCC_CR_HSIRDY (1u << 1)
#define RCC_CR_HSEON (1u << 16)
#define RCC_CR_HSERDY (1u << 17)
#define RCC_CR_CSSON (1u << 19)
#define RCC_CR_PLLON (1u << 24)
#define RCC_CR_PLLRDY (1u << 25)
#define RCC_PLLCFGR 0x04u
#define RCC_PLLCFGR_PLLM (0x3fu << 0)
#define RCC_PLLCFGR_PLLN (0x1ffu << 6)
#define RCC_PLLCFGR_PLLP (3u << 16)
#define RCC_PLLCFGR_PLLSRC (1u << 22)
#define RCC_PLLCFGR_PLLQ (0xfu << 24)
#define RCC_CFGR 0x08u
#define RCC_CFGR_SW (3u << 0)
#define RCC_CFGR_SWS (3u << 2)
#define RCC_CFGR_HPRE (0xfu << 4)
#define RCC_CFGR_PPRE1 (7u << 10)
#define RCC_CFGR_PPRE2 (7u << 13)
#define RCC_CIR 0x0cu
#define RCC_CIR_CSSC (1u << 23)
#define RCC_APB1RSTR 0x20u
#define RCC_APB1RSTR_CAN1RST (1u << 25)
#define RCC_AHB1ENR 0x30u
#define RCC_AHB1ENR_GPIOAEN (1u << 0)
#define RCC_AHB1ENR_DMA2EN (1u << 22)
#define RCC_AHB2ENR 0x34u
#define RCC_AHB2ENR_RNGEN (1u << 6)
#define RCC_APB1ENR 0x40u
#define RCC_APB1ENR_TIM2EN (1u << 0)
#define RCC_APB1ENR_TIM5EN (1u << 3)
#define RCC_APB1ENR_USART2EN (1u << 17)
#define RCC_APB1ENR_USART3EN (1u << 18)
#define RCC_APB1ENR_CAN1EN (1u << 25)
#define RCC_APB1ENR_PWREN (1u << 28)
#define RCC_APB2ENR 0x44u
#define RCC_APB2ENR_USART1EN (1u << 4)
#define RCC_APB2ENR_USART6EN (1u << 5)
#define RCC_CSR 0x74u
#define RCC_CSR_LSION (1u << 0)
#define RCC_CSR_LSIRDY (1u << 1)
#define RCC_CSR_RMVF (1u << 24)
#define RCC_CSR_BORRSTF (1u << 25)
#define RCC_CSR_PADRSTF (1u << 26)
#define RCC_CSR_PORRSTF (1u << 27)
#define RCC_CSR_SFTRSTF (1u << 28)
#define RCC_CSR_WDGRSTF (1u << 29)
#define RCC_CSR_WWDGRSTF (1u << 30)

/* Power control */
#define PWR_BASE 0x40007000u
#define PWR_CR 0x00u
#define PWR_CR_PVDE (1u << 4)
#define PWR_CR_PLS (7u << 5)
#define PWR_CSR 0x04u
#define PWR_CSR_PVDO (1u << 2)

/* Flash interface */
#define FLASH_BASE 0x40023c00u
#define FLASH_ACR 0x00u
#define FLASH_ACR_LATENCY (7u << 0)
#define FLASH_ACR_PRFTEN (1u << 8)
#define FLASH_ACR_ICEN (1u << 9)
#define FLASH_ACR_DCEN (1u << 10)
#define FLASH_ACR_ICRST (1u << 11)
#define FLASH_ACR_DCRST (1u << 12)
#define FLASH_KEYR 0x04u
#define FLASH_KEYR_KEY1 0x45670123u
#define FLASH_KEYR_KEY2 0xcdef89abu
#define FLASH_OPTKEYR 0x08u
#define FLASH_OPTKEYR_KEY1 0x08192a3bu
#define FLASH_OPTKEYR_KEY2 0x4c5d6e7fu
#define FLASH_SR 0x0cu
#define FLASH_SR_EOP (1u << 0)
#define FLASH_SR_OPERR (1u << 1)
#define FLASH_SR_WRPERR (1u << 4)
#define FLASH_SR_PGAERR (1u << 5)
#define FLASH_SR_PGPERR (1u << 6)
#define FLASH_SR_PGSERR (1u << 7)
#define FLASH_SR_BSY (1u << 16)
#define FLASH_CR 0x10u
#define FLASH_CR_PG (1u << 0)
#define FLASH_CR_SER (1u << 1)
#define FLASH_CR_SNB (0xfu << 3)
#define FLASH_CR_PSIZE (3u << 8)
#define FLASH_CR_STRT (1u << 16)
#define FLASH_CR_LOCK (1u << 31)
#define FLASH_OPTCR 0x14u
#define FLASH_OPTCR_OPTLOCK (1u << 0)
#define FLASH_OPTCR_OPTSTRT (1u << 1)
#define FLASH_OPTCR_BOR_LEV (3u << 2)

/* Random numbers */
#define RNG_BASE 0x50060800u
#define RNG_CR 0x00u
#define RNG_CR_RNGEN (1u << 2)
#define RNG_SR 0x04u
#define RNG_SR_DRDY (1u << 0)
#define RNG_SR_CECS (1u << 1)
#define RNG_SR_SECS (1u << 2)
#define RNG_SR_CEIS (1u << 5)
#define RNG_SR_SEIS (1u << 6)
#define RNG_DR 0x08u

/* Pins; ports follow each other at equal distance */
#define GPIOA_BASE 0x40020000u
#define GPIOB_BASE 0x40020400u
#define GPIO_MODER 0x00u
#define GPIO_OSPEEDR 0x08u
#define GPIO_PUPDR 0x0cu
#define GPIO_BSRR 0x18u
#define GPIO_AFRL 0x20u
#define GPIO_AFRH 0x24u

/* Timers: TIM2 keeps the time, TIM5 measures the LSI */
#define TIM2_BASE 0x40000000u
#define TIM2_CR1 0x00u
#define TIM2_CR1_CEN (1u << 0)
#define TIM2_EGR 0x14u
#define TIM2_EGR_UG (1u << 0)
#define TIM2_CNT 0x24u
#define TIM2_PSC 0x28u
#define TIM2_ARR 0x2cu
#define TIM5_BASE 0x40000c00u
#define TIM5_CR1 0x00u
#define TIM5_CR1_CEN (1u << 0)
#define TIM5_SR 0x10u
#define TIM5_SR_CC4IF (1u << 4)
#define TIM5_EGR 0x14u
#define TIM5_EGR_UG (1u << 0)
#define TIM5_CCMR2_Input 0x1cu
#define TIM5_CCMR2_Input_CC4S (3u << 8)
#define TIM5_CCMR2_Input_IC4PSC (3u << 10)
#define TIM5_CCER 0x20u
#define TIM5_CCER_CC4E (1u << 12)
#define TIM5_PSC 0x28u
#define TIM5_ARR 0x2cu
#define TIM5_CCR4 0x40u
#define TIM5_OR 0x50u
#define TIM5_OR_IT4_RMP (3u << 6)

/* Serial ports */
#define USART1_BASE 0x40011000u
#define USART2_BASE 0x40004400u
#define USART3_BASE 0x40004800u
#define USART6_BASE 0x40011400u
#define USART_SR 0x00u
#define USART_SR_PE (1u << 0)
#define USART_SR_FE (1u << 1)
#define USART_SR_ORE (1u << 3)
#define USART_SR_RXNE (1u << 5)
#define USART_SR_TC (1u << 6)
#define USART_SR_TXE (1u << 7)
#define USART_DR 0x04u
#define USART_BRR 0x08u
#define USART_CR1 0x0cu
#define USART_CR1_RE (1u << 2)
#define USART_CR1_TE (1u << 3)
#define USART_CR1_RXNEIE (1u << 5)
#define USART_CR1_TCIE (1u << 6)
#define USART_CR1_TXEIE (1u << 7)
#define USART_CR1_PS (1u << 9)
#define USART_CR1_PCE (1u << 10)
#define USART_CR1_M (1u << 12)
#define USART_CR1_UE (1u << 13)
#define USART_CR2 0x10u
#define USART_CR3 0x14u
#define USART_CR3_DMAR (1u << 6)
#define USART_CR3_DMAT (1u << 7)
#define USART1_IRQ 37u
#define USART2_IRQ 38u
#define USART3_IRQ 39u
#define USART6_IRQ 71u

/* DMA 2: stream 1 receives for USART6, stream 6 sends, both on channel 5 */
#define DMA2_BASE 0x40026400u
#define DMA2_LIFCR 0x08u
#define DMA2_LIFCR_CFEIF1 (1u << 6)
#define DMA2_LIFCR_CDMEIF1 (1u << 8)
#define DMA2_LIFCR_CTEIF1 (1u << 9)
#define DMA2_LIFCR_CHTIF1 (1u << 10)
#define DMA2_LIFCR_CTCIF1 (1u << 11)
#define DMA2_HIFCR 0x0cu
#define DMA2_HIFCR_CFEIF6 (1u << 16)
#define DMA2_HIFCR_CDMEIF6 (1u << 18)
#define DMA2_HIFCR_CTEIF6 (1u << 19)
#define DMA2_HIFCR_CHTIF6 (1u << 20)
#define DMA2_HIFCR_CTCIF6 (1u << 21)
#define DMA2_S1CR 0x28u
#define DMA2_S1CR_EN (1u << 0)
#define DMA2_S1CR_DIR (3u << 6)
#define DMA2_S1CR_CIRC (1u << 8)
#define DMA2_S1CR_MINC (1u << 10)
#define DMA2_S1CR_CHSEL (7u << 25)
#define DMA2_S1NDTR 0x2cu
#define DMA2_S1PAR 0x30u
#define DMA2_S1M0AR 0x34u
#define DMA2_S6CR 0xa0u
#define DMA2_S6CR_EN (1u << 0)
#define DMA2_S6CR_DIR (3u << 6)
#define DMA2_S6CR_MINC (1u << 10)
#define DMA2_S6CR_CHSEL (7u << 25)
#define DMA2_S6NDTR 0xa4u
#define DMA2_S6PAR 0xa8u
#define DMA2_S6M0AR 0xacu

/* bxCAN */
#define CAN1_BASE 0x40006400u
#define CAN_MCR 0x00u
#define CAN_MCR_INRQ (1u << 0)
#define CAN_MCR_SLEEP (1u << 1)
#define CAN_MCR_TXFP (1u << 2)
#define CAN_MCR_RFLM (1u << 3)
#define CAN_MSR 0x04u
#define CAN_MSR_INAK (1u << 0)
#define CAN_MSR_SLAK (1u << 1)
#define CAN_TSR 0x08u
#define CAN_TSR_ABRQ0 (1u << 7)
#define CAN_TSR_ABRQ1 (1u << 15)
#define CAN_TSR_ABRQ2 (1u << 23)
#define CAN_TSR_TME0 (1u << 26)
#define CAN_TSR_TME1 (1u << 27)
#define CAN_TSR_TME2 (1u << 28)
#define CAN_RF0R 0x0cu
#define CAN_RF0R_FMP0 (3u << 0)
#define CAN_RF0R_FULL0 (1u << 3)
#define CAN_RF0R_FOVR0 (1u << 4)
#define CAN_RF0R_RFOM0 (1u << 5)
#define CAN_RF1R 0x10u
#define CAN_RF1R_FMP1 (3u << 0)
#define CAN_RF1R_RFOM1 (1u << 5)
#define CAN_IER 0x14u
#define CAN_IER_FMPIE0 (1u << 1)
#define CAN_IER_FOVIE0 (1u << 3)
#define CAN_ESR 0x18u
#define CAN_ESR_EPVF (1u << 1)
#define CAN_ESR_BOFF (1u << 2)
#define CAN_ESR_TEC (0xffu << 16)
#define CAN_ESR_REC (0xffu << 24)
#define CAN_BTR 0x1cu
#define CAN_BTR_BRP (0x3ffu << 0)
#define CAN_BTR_TS1 (0xfu << 16)
#define CAN_BTR_TS2 (7u << 20)
#define CAN_BTR_SJW (3u << 24)
#define CAN_BTR_LBKM (1u << 30)
#define CAN_BTR_SILM (1u << 31)
#define CAN_TI0R 0x180u
#define CAN_TI0R_TXRQ (1u << 0)
#define CAN_TI0R_STID (0x7ffu << 21)
#define CAN_TDT0R 0x184u
#define CAN_TDT0R_DLC (0xfu << 0)
#define CAN_TDL0R 0x188u
#define CAN_TDH0R 0x18cu
#define CAN_TI1R 0x190u
#define CAN_RI0R 0x1b0u
#define CAN_RI0R_RTR (1u << 1)
#define CAN_RI0R_IDE (1u << 2)
#define CAN_RI0R_STID (0x7ffu << 21)
#define CAN_RDT0R 0x1b4u
#define CAN_RDT0R_DLC (0xfu << 0)
#define CAN_RDL0R 0x1b8u
#define CAN_RDH0R 0x1bcu
#define CAN_RI1R 0x1c0u
#define CAN_FMR 0x200u
#define CAN_FMR_FINIT (1u << 0)
#define CAN_FM1R 0x204u
#define CAN_FM1R_FBM0 (1u << 0)
#define CAN_FM1R_FBM1 (1u << 1)
#define CAN_FS1R 0x20cu
#define CAN_FS1R_FSC0 (1u << 0)
#define CAN_FS1R_FSC1 (1u << 1)
#define CAN_FFA1R 0x214u
#define CAN_FFA1R_FFA0 (1u << 0)
#define CAN_FFA1R_FFA1 (1u << 1)
#define CAN_FA1R 0x21cu
#define CAN_FA1R_FACT0 (1u << 0)
#define CAN_FA1R_FACT1 (1u << 1)
#define CAN_F0R1 0x240u
#define CAN_F0R2 0x244u
#define CAN_F1R1 0x248u
#define CAN_F1R2 0x24cu
#define CAN1_RX0_IRQ 20u

/* Independent watchdog */
#define IWDG_BASE 0x40003000u
#define IWDG_KR 0x00u
#define IWDG_KR_ACCESS_KEY 0x5555u
#define IWDG_KR_RELOAD_KEY 0xaaaau
#define IWDG_KR_START_KEY 0xccccu
#define IWDG_PR 0x04u
#define IWDG_PR_PR (7u << 0)
#define IWDG_RLR 0x08u
#define IWDG_RLR_RL (0xfffu << 0)
#define IWDG_SR 0x0cu
#define IWDG_SR_PVU (1u << 0)
#define IWDG_SR_RVU (1u << 1)

/* Debug: what stops while the processor is halted */
#define DBG_BASE 0xe0042000u
#define DBG_DBGMCU_APB1_FZ 0x08u
#define DBG_DBGMCU_APB1_FZ_DBG_IWDEG_STOP (1u << 12)

/* Processor core: interrupt controller, system control */
#define NVIC_BASE 0xe000e000u
#define NVIC_ISER0 0x100u
#define NVIC_ISER1 0x104u
#define NVIC_ISPR0 0x200u
#define NVIC_ISPR1 0x204u
#define SCB_BASE 0xe000ed00u
#define SCB_AIRCR 0x0cu
#define SCB_AIRCR_SYSRESETREQ (1u << 2)
#define SCB_AIRCR_VECTKEY (0xffffu << 16)
#define SCB_AIRCR_VECTKEY_KEY 0x05fau

#endif
