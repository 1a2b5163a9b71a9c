use super::*;
use crate::host::{Found, Host, Place};
use antumbra::image::Still;
use std::{fs, path::Path};

/// A host that writes files beside their names first.
struct Folder;

struct Beside(PathBuf);

impl Place for Beside {
    fn fill(self: Box<Self>, bytes: &[u8]) -> Result<(), String> {
        fs::write(&self.0, bytes).map_err(|e| e.to_string())
    }
}

impl Host for Folder {
    fn find(&self, text: &str) -> Result<Found, String> {
        Err(format!("nobody looks for {text}"))
    }

    fn reserve(&self, path: &Path) -> Result<Box<dyn Place>, String> {
        if path.parent().is_some_and(Path::is_dir) {
            Ok(Box::new(Beside(path.to_owned())))
        } else {
            Err("no folder".to_owned())
        }
    }
}

fn order(path: PathBuf) -> Order {
    Order {
        path,
        name: "formula".to_owned(),
        file: SceneFile::of_formula("x^2 + y^2 + z^2 = 1"),
        size: [60, 40],
        method: Method::Certified,
        overlay: None,
        deep: false,
    }
}

fn end(export: &Export) -> Progress {
    loop {
        match export.progress() {
            Progress::Drawing(..) => std::thread::sleep(Duration::from_millis(5)),
            other => return other,
        }
    }
}

fn begin(order: Order) -> Result<Export, String> {
    let host: SharedHost = Arc::new(Folder);
    Export::begin(order, &host, RunSpec::default(), || {})
}

#[test]
fn a_picture_of_the_size_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("ball.png");
    assert_eq!(end(&begin(order(path.clone())).unwrap()), Progress::Written(path.clone()));
    let still = Still::read(&fs::read(&path).unwrap()).unwrap();
    assert_eq!((still.width, still.height), (60, 40));
    assert!(still.codes.iter().max() > Some(&128), "there is light");
    let exr = folder.path().join("ball.exr");
    assert_eq!(end(&begin(order(exr.clone())).unwrap()), Progress::Written(exr.clone()));
    assert_eq!(fs::read(&exr).unwrap()[..4], [0x76, 0x2f, 0x31, 0x01], "the magic number of EXR");
    let legend = folder.path().join("verdict.png");
    let with = Order { overlay: Some(Overlay::Verdict), deep: true, ..order(legend.clone()) };
    assert_eq!(end(&begin(with).unwrap()), Progress::Written(legend));
}

#[test]
fn what_is_cancelled_or_wrong_leaves_no_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("large.png");
    let export = begin(Order { size: [4000, 4000], ..order(path.clone()) }).unwrap();
    export.cancel();
    assert_eq!(end(&export), Progress::Cancelled);
    let bad = Order { file: SceneFile::of_formula("x +"), ..order(path.clone()) };
    assert!(matches!(end(&begin(bad).unwrap()), Progress::Failed(_)));
    assert!(!path.exists());
    let refused = |order: Order| begin(order).err().expect("it is refused");
    assert!(refused(order("a.jpg".into())).contains(".png or .exr"));
    assert!(refused(order("/nowhere/at/all.png".into())).contains("no folder"));
    assert!(refused(Order { size: [0, 5], ..order(path) }).contains("pixel a side"));
}
