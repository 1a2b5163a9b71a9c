//! The near end of a browser's GPU, with a native one at the far end: what crosses is orders and answers. Where there is no adapter, the tests
//! say loudly that they are skipped (and fail if `ANTUMBRA_GPU_REQUIRED` is set).
use antumbra_gpu::{Error, Gpu, Machine, Usage};
use antumbra_web::Studio;
use serde_json::{Value, json};
use std::collections::HashMap;
use std::task::{Context, Poll, Waker};
use std::time::Duration;

/// What holds the GPU, as the page does.
struct Holder {
    gpu: Gpu,
    buffers: HashMap<u64, <Gpu as Machine>::Buffer>,
    pipelines: HashMap<u64, <Gpu as Machine>::Pipeline>,
    binds: HashMap<u64, <Gpu as Machine>::Binding>,
}

/// A native GPU never leaves anything to wait for.
fn ready<T>(work: impl Future<Output = Result<T, Error>>) -> T {
    match std::pin::pin!(work).poll(&mut Context::from_waker(Waker::noop())) {
        Poll::Ready(done) => done.unwrap(),
        Poll::Pending => panic!("it waits"),
    }
}

impl Holder {
    fn open() -> Option<Self> {
        match Gpu::open(true) {
            Ok(gpu) => {
                let (buffers, pipelines, binds) = Default::default();
                Some(Self { gpu, buffers, pipelines, binds })
            }
            Err(Error::NoAdapter) if std::env::var_os("ANTUMBRA_GPU_REQUIRED").is_none() => {
                eprintln!("SKIPPED: no adapter here, nothing was run on a GPU");
                None
            }
            Err(error) => panic!("{error}"),
        }
    }

    /// Carries out orders; the ticket and the answer of the last one.
    fn perform(&mut self, orders: &Value) -> Option<(u32, Vec<u8>)> {
        let mut last = None;
        for order in orders.as_array().unwrap() {
            let number = |key: &str| order[key].as_u64().unwrap_or_else(|| panic!("{key} of {order}"));
            let ticket = || u32::try_from(number("ticket")).unwrap();
            let Self { gpu, buffers, pipelines, binds } = self;
            match order["do"].as_str().unwrap() {
                "buffer" => {
                    let usage = if order["uniform"] == true { Usage::Uniform } else { Usage::Storage };
                    buffers.insert(number("id"), Machine::buffer(gpu, number("bytes"), usage).unwrap());
                }
                "pipeline" => {
                    let constants: Vec<(&str, f64)> = order["constants"]
                        .as_object()
                        .unwrap()
                        .iter()
                        .map(|(k, v)| (&**k, v.as_f64().unwrap()))
                        .collect();
                    let [text, entry] = ["text", "entry"].map(|key| order[key].as_str().unwrap());
                    pipelines.insert(number("id"), Machine::pipeline(gpu, text, entry, &constants).unwrap());
                }
                "bind" => {
                    let places: Vec<(u32, u64)> = serde_json::from_value(order["buffers"].clone()).unwrap();
                    let places: Vec<_> = places.iter().map(|(place, id)| (*place, &buffers[id])).collect();
                    binds.insert(number("id"), Machine::bind(gpu, &pipelines[&number("pipeline")], &places).unwrap());
                }
                "free" => {
                    let id = number("id");
                    let held =
                        [buffers.remove(&id).is_some(), pipelines.remove(&id).is_some(), binds.remove(&id).is_some()];
                    assert!(held.contains(&true), "{id} is freed, and was never made");
                }
                "write" => {
                    let words: Vec<u32> = serde_json::from_value(order["words"].clone()).unwrap();
                    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
                    Machine::write(gpu, &buffers[&number("id")], &bytes);
                }
                "clear" => Machine::clear(gpu, &[&buffers[&number("id")]]),
                "copy" => Machine::copy(gpu, &buffers[&number("from")], &buffers[&number("to")]),
                "run" => {
                    let (pipeline, binding) = (&pipelines[&number("pipeline")], &binds[&number("binding")]);
                    ready(Machine::run(gpu, pipeline, binding, u32::try_from(number("groups")).unwrap()));
                    last = Some((ticket(), Vec::new()));
                }
                "read" => {
                    last = Some((ticket(), ready(Machine::read(gpu, &buffers[&number("id")], number("bytes")))));
                }
                other => panic!("{other}"),
            }
        }
        last
    }

    /// Goes on until it is decided; `change` may spoil the answers by their number.
    fn decide(&mut self, studio: &mut Studio, mut change: impl FnMut(usize, &mut Result<Vec<u8>, String>)) -> Value {
        for number in 0.. {
            let step: Value = serde_json::from_str(&studio.gpu_step()).unwrap();
            let last = self.perform(&step["orders"]);
            if step["state"] != "waits" {
                return step;
            }
            let (ticket, answer) = last.expect("who waits has asked");
            let mut answer = Ok(answer);
            change(number, &mut answer);
            studio.gpu_answer(ticket, answer);
        }
        unreachable!()
    }

    fn probed(&mut self) -> Studio {
        let mut studio = Studio::default();
        let about = json!({ "name": self.gpu.name(), "software": self.gpu.is_software(), "largest": 1 << 28 });
        assert_eq!(studio.gpu_open(&about.to_string()), "");
        let passed = self.decide(&mut studio, |_, _| ());
        assert_eq!((&passed["state"], &passed["cases"]), (&json!("passed"), &json!(16384)), "{passed}");
        studio
    }
}

fn open(studio: &mut Studio, scene: &str) {
    let request = json!({ "scene": scene, "width": 40, "height": 40 });
    let answer: Value = serde_json::from_str(&studio.open(&request.to_string())).unwrap();
    assert!(answer["error"].is_null(), "{answer}");
}

/// All planes of the picture, finished.
fn planes(studio: &mut Studio) -> Vec<Vec<u8>> {
    while !studio.refine(Duration::MAX) {}
    let names: Vec<String> = serde_json::from_str(&studio.planes()).unwrap();
    names.iter().map(|name| studio.npy(name)).collect()
}

fn alone(scene: &str) -> Studio {
    let mut studio = Studio::default();
    open(&mut studio, scene);
    studio
}

#[test]
fn a_picture_is_proved_over_there_and_finished_here() {
    let Some(mut holder) = Holder::open() else { return };
    let mut studio = holder.probed();
    for _ in 0..2 {
        open(&mut studio, "chubs");
        assert_eq!(studio.gpu_begin(), "");
        let proved = holder.decide(&mut studio, |_, _| ());
        assert_eq!(proved["state"], "proved", "{proved}");
        let count = |key: &str| proved[key].as_u64().unwrap();
        assert!(
            10 * count("settled") > 4 * count("pixels") && 10 * count("narrow") > 8 * count("brackets"),
            "{proved}"
        );
        let mut one = alone("chubs");
        assert_ne!(planes(&mut studio), planes(&mut one), "nothing was taken over");
        assert_eq!(studio.npy("verdict"), one.npy("verdict"));
    }
    // What is not needed any more was freed: the kernels are left.
    assert_eq!((holder.buffers.len(), holder.binds.len(), holder.pipelines.len()), (0, 0, 6));
}

#[test]
fn what_fails_there_is_told_and_the_processor_does_it() {
    let Some(mut holder) = Holder::open() else { return };
    let mut studio = holder.probed();
    let processor = planes(&mut alone("sphere"));
    for spoiled in [0, 3, 7] {
        open(&mut studio, "sphere");
        assert_eq!(studio.gpu_begin(), "");
        let step = holder.decide(&mut studio, |number, answer| {
            if number == spoiled {
                *answer = Err("the device was lost".to_owned());
            }
        });
        assert_eq!(step["state"], "failed");
        assert!(step["message"].as_str().unwrap().contains("the device was lost"), "{step}");
        assert_eq!(planes(&mut studio), processor);
    }
    // Half an answer is none.
    open(&mut studio, "sphere");
    studio.gpu_begin();
    let step = holder.decide(&mut studio, |_, answer| {
        if let Ok(bytes) = answer {
            bytes.truncate(bytes.len() / 2);
        }
    });
    assert_eq!(step["state"], "failed", "{step}");
    open(&mut studio, "atan(x) + y^2 + z^2 = 1");
    assert!(studio.gpu_begin().contains("`atan`"));
}

#[test]
fn proofs_of_another_picture_are_nobodys() {
    let Some(mut holder) = Holder::open() else { return };
    let mut studio = holder.probed();
    open(&mut studio, "torus");
    studio.gpu_begin();
    let step: Value = serde_json::from_str(&studio.gpu_step()).unwrap();
    let (ticket, late) = holder.perform(&step["orders"]).unwrap();
    // Another picture of the same size: what was being proved is not of it, and its answers come too late.
    open(&mut studio, "sphere");
    studio.gpu_answer(ticket, Ok(late.clone()));
    let step: Value = serde_json::from_str(&studio.gpu_step()).unwrap();
    assert_eq!(step["state"], "idle", "{step}");
    holder.perform(&step["orders"]);
    assert_eq!(studio.gpu_begin(), "");
    let proved = holder.decide(&mut studio, |_, _| ());
    assert_eq!(proved["state"], "proved");
    planes(&mut studio);
    let mut one = alone("sphere");
    planes(&mut one);
    assert_eq!(studio.npy("verdict"), one.npy("verdict"));
    // An answer with another ticket is not taken.
    open(&mut studio, "sphere");
    studio.gpu_begin();
    let step: Value = serde_json::from_str(&studio.gpu_step()).unwrap();
    holder.perform(&step["orders"]);
    studio.gpu_answer(ticket, Ok(late));
    let step: Value = serde_json::from_str(&studio.gpu_step()).unwrap();
    assert_eq!((&step["state"], &step["orders"]), (&json!("waits"), &json!([])), "{step}");
}

#[test]
fn a_gpu_that_answers_wrongly_is_refused() {
    let Some(mut holder) = Holder::open() else { return };
    let mut studio = Studio::default();
    assert!(studio.gpu_open("{}").contains("name"));
    let about = json!({ "name": "a liar", "software": true, "largest": 1 << 28 });
    studio.gpu_open(&about.to_string());
    // The last bit of one product in 16384.
    let step = holder.decide(&mut studio, |_, answer| {
        if let Ok(bytes) = answer
            && bytes.len() == 16384 * 48
        {
            bytes[48 * 5000 + 8] ^= 1;
        }
    });
    assert_eq!(step["state"], "failed");
    assert!(step["message"].as_str().unwrap().contains("`a liar` failed the start-up probe"), "{step}");
    open(&mut studio, "sphere");
    assert!(studio.gpu_begin().contains("has not passed"));
}
