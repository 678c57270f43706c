/* The report page as bytes of the program. */
        .section .rodata
        .global millscope_page_begin
        .global millscope_page_end
millscope_page_begin:
        .incbin MILLSCOPE_PAGE
millscope_page_end:
        .byte 0
        .section .note.GNU-stack, "", @progbits
