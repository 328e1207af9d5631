#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    tyndall_fuzz::frame::on_gpu(bytes);
});
