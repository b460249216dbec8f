//! The arms that the tests generate code for: the whole catalogue, and the
//! package's own in `tests/robots`, which have what the catalogue lacks.

use robstiff_robots::{Description, catalogue};

/// A test for each arm: `for_every_arm!(check)` calls `check(robot, &file)`
/// with the generated robot and its description's file.
#[macro_export]
macro_rules! for_every_arm {
    ([define] $($module:ident $name:ident $file:literal),*) => {
        $(robstiff::robot!($file);)*

        /// The arms' files.
        pub const FILES: &[&str] = &[$($file),*];
    };
    ([test $check:ident] $($module:ident $name:ident $file:literal),*) => {
        mod $check {
            $(
                #[test]
                fn $module() {
                    super::$check($crate::arms::$name, $file);
                }
            )*
        }
    };
    ([list] $($task:tt)*) => {
        $crate::for_every_arm! {
            $($task)*
            abb_irb6600 AbbIrb6600 "abb-irb6600-225-255.yaml",
            abb_irb6640 AbbIrb6640 "abb-irb6640-185-280.yaml",
            fanuc_m900ib FanucM900ib700 "fanuc-m900ib-700.yaml",
            fanuc_r2000ic FanucR2000ic "fanuc-r2000ic.yaml",
            kuka_kr210 KukaKr210L150 "kuka-kr210-l150.yaml",
            kuka_kr270 KukaKr270R2700 "kuka-kr270-r2700.yaml",
            rv130hsc Rv130hsc "rv130hsc.yaml",
            staubli_rx160 StaubliRx160 "staubli-rx160.yaml",
            every_effect EveryEffect "every-effect.yaml",
            every_law EveryLaw "every-law.yaml",
            flexible_on_a_wall FlexibleOnAWall "flexible-on-a-wall.yaml",
            hanging Hanging "hanging.yaml",
            modified_slider ModifiedSlider "modified-slider.yaml",
            pendulum Pendulum "pendulum.yaml",
            preloaded Preloaded "preloaded.yaml",
            scara Scara "scara.yaml",
            sliders Sliders "sliders.yaml",
            snake Snake "snake.yaml",
            turned_tool TurnedTool "turned-tool.yaml"
        }
    };
    ($check:ident) => {
        $crate::for_every_arm! { [list] [test $check] }
    };
}

for_every_arm! { [list] [define] }

/// The description of an arm, by its file's name.
///
/// # Panics
/// Where it cannot be read.
pub fn description(file: &str) -> Description {
    let own = concat!(env!("CARGO_MANIFEST_DIR"), "/robots/");
    match catalogue::find(file) {
        Some(text) => Description::parse(file, text).unwrap_or_else(|problems| panic!("{problems}")),
        None => Description::read(own.to_owned() + file).unwrap_or_else(|problems| panic!("{problems}")),
    }
}
